// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <functional>

#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal {

/// A recording that a test changes with HDF5 itself, so that it has no checksum
/// any more.
class ChangedHdf5 : public DirectoryFixture {
 protected:
  ChangedHdf5() { write_recording(sample_recording(kSamples), file); }

  void change(const std::function<void(hid_t)>& work) const {
    H5Id id(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "open");
    work(id);
    id.close("close");
  }
  /// What reading says, without the name of the file.
  std::string rejected() const {
    const std::string message = rejection([&] { read_recording(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_FALSE(holds(message, "\n"));
    return message.substr(std::min(message.size(), file.string().size() + 2));
  }
  std::string rejected(const std::function<void(hid_t)>& work) const {
    change(work);
    return rejected();
  }

  static constexpr hsize_t kSamples = 20;
  const std::filesystem::path file = directory / "run.h5";
};

}  // namespace beamgyro::internal
