// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/hdf5_write.h"
#include "tests/dataset/netcdf/changed_hdf5.h"

namespace beamgyro::internal::hdf5_rejection_test {
namespace {

namespace fs = std::filesystem;

using Hdf5Rejection = ChangedHdf5;

/// Properties of a variable whose values have a place before they are written.
hid_t with_a_place() {
  static const H5Id properties = property_list(H5P_DATASET_CREATE);
  H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
  return properties;
}

void replace(hid_t file, const std::string& name, hid_t type,
             std::span<const hsize_t> lengths) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const H5Id variable = make_variable(file, {name, "1", name}, type,
                                      space_of(lengths), with_a_place(), {});
  if (H5Tget_class(type) == H5T_STRING || lengths.size() > 1) return;
  const std::vector<double> zeros(lengths[0]);
  H5Dwrite(variable, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
           zeros.data());
}

void write_bias(hid_t file, double first) {
  std::vector<double> values(20);
  values[0] = first;
  const H5Id bias(H5Dopen2(file, "true_bias", H5P_DEFAULT), H5Dclose, "open");
  H5Dwrite(bias, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
           values.data());
}

void set_text(hid_t file, const char* owner, const char* name,
              const std::string& text) {
  H5Adelete_by_name(file, owner, name, H5P_DEFAULT);
  const H5Id object(H5Oopen(file, owner, H5P_DEFAULT), H5Oclose, "open");
  write_text(object, name, text);
}

TEST_F(Hdf5Rejection, MissingFilesAndDirectories) {
  fs::remove(file);
  EXPECT_EQ(rejected(), "cannot read: No such file or directory");
  EXPECT_EQ(
      rejection([&] { read_recording(directory); }),
      directory.string() + ": not a file; expected a recording of beamgyro");
}

TEST_F(Hdf5Rejection, FilesThatAreNotHdf5) {
  for (const char* text : {"", "time,rate\n0,1\n", "\x89HDF"}) {
    write_text_file(file, text);
    EXPECT_EQ(rejected(), "not an HDF5 file; expected a recording of beamgyro");
  }
}

TEST_F(Hdf5Rejection, TruncatedFilesOfAnyLength) {
  const std::string bytes = read_text_file(file);
  for (std::size_t cut = 1; cut <= bytes.size(); cut += 97) {
    fs::resize_file(file, bytes.size() - cut);
    EXPECT_NE(rejected(), "");
  }
  write_text_file(file, std::string_view(bytes).substr(0, bytes.size() - 1));
  EXPECT_EQ(rejected(),
            "ends in bytes that are neither values nor a checksum: the file is "
            "damaged; expected it as beamgyro wrote it");
  change([](hid_t) {});  // HDF5 drops the checksum of what it may change
  const auto whole = fs::file_size(file);
  fs::resize_file(file, whole - 1);
  EXPECT_EQ(rejected(), std::to_string(whole - 1) + " of " +
                            std::to_string(whole) +
                            " bytes are there; expected a whole copy");
}

TEST_F(Hdf5Rejection, OtherFiletypes) {
  change([](hid_t id) { set_text(id, "/", "filetype", "beamgyro-other"); });
  const std::string expected =
      "not a recording of beamgyro; expected the attribute filetype = "
      "\"beamgyro-recording\"";
  EXPECT_EQ(rejected(), expected);
  EXPECT_EQ(rejected([](hid_t id) { H5Adelete(id, "filetype"); }), expected);
}

TEST_F(Hdf5Rejection, NewerFormats) {
  EXPECT_EQ(rejected([](hid_t id) {
              const int version = 3;
              H5Adelete(id, "format_version");
              write_attribute(id, "format_version", H5T_NATIVE_INT,
                              scalar_space(), &version);
            }),
            "format_version 3 is not known; this program reads up to 2");
}

TEST_F(Hdf5Rejection, MissingAttributes) {
  EXPECT_EQ(rejected([](hid_t id) {
              H5Adelete_by_name(id, "temperature", "role", H5P_DEFAULT);
            }),
            "temperature has no attribute role");
  EXPECT_EQ(rejected([](hid_t id) { H5Adelete(id, "seed"); }),
            "the file has no attribute seed");
}

TEST_F(Hdf5Rejection, UnknownRoles) {
  EXPECT_EQ(
      rejected([](hid_t id) { set_text(id, "/output", "role", "guess"); }),
      "output has the role 'guess'; expected measured, truth or "
      "compensated");
}

TEST_F(Hdf5Rejection, MissingTimeOrStatus) {
  change([](hid_t id) { H5Ldelete(id, "status", H5P_DEFAULT); });
  EXPECT_TRUE(rejected().starts_with("cannot open status: ")) << rejected();
  change([](hid_t id) { H5Ldelete(id, "time", H5P_DEFAULT); });
  EXPECT_TRUE(rejected().starts_with("cannot open time: ")) << rejected();
}

TEST_F(Hdf5Rejection, ValuesWhoseSquaresOverflow) {
  change([](hid_t id) { write_bias(id, 1e12); });
  EXPECT_NO_THROW(read_recording(file));
  EXPECT_EQ(rejected([](hid_t id) { write_bias(id, -1e300); }),
            "true_bias: sample 0 is -1e+300; expected at most +-1e+12");
}

TEST_F(Hdf5Rejection, VariablesOfAnotherLengthOrType) {
  EXPECT_EQ(rejected([](hid_t id) {
              replace(id, "status", H5T_STD_U8LE, std::array<hsize_t, 1>{7});
            }),
            "status has 7 values; expected 20");
  EXPECT_EQ(rejected([](hid_t id) {
              replace(id, "status", H5T_IEEE_F64LE,
                      std::array<hsize_t, 1>{kSamples});
            }),
            "status has another type; expected unsigned bytes");
  EXPECT_EQ(rejected([](hid_t id) {
              replace(id, "time", H5T_C_S1, std::array<hsize_t, 1>{kSamples});
            }),
            "time has another type; expected floating point");
}

TEST_F(Hdf5Rejection, VariablesOfTwoDimensions) {
  EXPECT_EQ(rejected([](hid_t id) {
              replace(id, "time", H5T_IEEE_F64LE, std::array<hsize_t, 2>{3, 4});
            }),
            "time has 2 dimensions; expected one");
}

TEST_F(Hdf5Rejection, VariablesWithoutTheirValues) {
  change([](hid_t id) {
    H5Ldelete(id, "time", H5P_DEFAULT);
    make_variable(id, {"time", "s", "time"}, H5T_IEEE_F64LE,
                  space_of(std::array{hsize_t{1} << 50}), H5P_DEFAULT, {});
  });
  EXPECT_EQ(rejected(), "the values of time are missing");
}

TEST_F(Hdf5Rejection, TheErrorStackIsNotPrinted) {
  ::testing::internal::CaptureStderr();
  write_text_file(file, read_text_file(file).substr(0, 3000));
  rejected();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Hdf5Rejection, AFileWithoutMetaHasEmptyTexts) {
  change([](hid_t id) { H5Ldelete(id, "meta", H5P_DEFAULT); });
  EXPECT_EQ(read_recording(file).scenario_text, "");
}

}  // namespace
}  // namespace beamgyro::internal::hdf5_rejection_test
