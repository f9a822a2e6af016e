// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>

#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "tests/dataset/sample_recording.h"

namespace beamgyro::internal::hdf5_globals_test {
namespace {

herr_t own_handler(hid_t, void*) { return 0; }

// A process may use HDF5 for something else, too.
TEST(Hdf5Globals, AreAfterAFileWhatTheyWereBefore) {
  H5E_auto2_t before = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  unsigned plugins_before = 0;
  H5PLget_loading_state(&plugins_before);
  int mine = 0;
  H5Eset_auto2(H5E_DEFAULT, own_handler, &mine);
  H5PLset_loading_state(H5PL_ALL_PLUGIN);

  const auto file = std::filesystem::path(::testing::TempDir()) / "globals.h5";
  write_recording(sample_recording(10), file);
  read_recording(file);
  std::filesystem::remove(file);

  H5E_auto2_t handler = nullptr;
  void* given = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &handler, &given);
  unsigned plugins = 0;
  H5PLget_loading_state(&plugins);
  EXPECT_EQ(handler, own_handler);
  EXPECT_EQ(given, &mine);
  EXPECT_EQ(plugins, static_cast<unsigned>(H5PL_ALL_PLUGIN));
  H5Eset_auto2(H5E_DEFAULT, before, data);
  H5PLset_loading_state(plugins_before);
}

}  // namespace
}  // namespace beamgyro::internal::hdf5_globals_test
