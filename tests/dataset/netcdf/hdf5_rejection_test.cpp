// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"

namespace beamgyro::internal::hdf5_rejection_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSamples = 20;

/// A good file of 20 samples that a test damages with HDF5 itself.
class Hdf5Rejection : public ::testing::Test {
 protected:
  void SetUp() override {
    file = fs::path(::testing::TempDir()) /
           ("rejected " + std::to_string(getpid()) + ".h5");
    write_recording(sample_recording(kSamples), file);
  }
  void TearDown() override { fs::remove(file); }

  void damage(const std::function<void(hid_t)>& change) const {
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(id, 0);
    change(id);
    ASSERT_GE(H5Fclose(id), 0);
  }

  std::string rejected() const {
    const std::string message = rejection([&] { read_recording(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(std::min(message.size(), file.string().size() + 2));
  }

  fs::path file;
};

/// Properties of a variable whose values have a place before they are written.
hid_t with_a_place() {
  static const hid_t properties = [] {
    const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_alloc_time(made, H5D_ALLOC_TIME_EARLY);
    return made;
  }();
  return properties;
}

void replace(hid_t file, const char* name, hid_t type, hsize_t length) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &length, nullptr);
  const hid_t variable = H5Dcreate2(file, name, type, space, H5P_DEFAULT,
                                    with_a_place(), H5P_DEFAULT);
  std::vector<double> zeros(length);
  if (H5Tget_class(type) != H5T_STRING)
    H5Dwrite(variable, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
             zeros.data());
  H5Dclose(variable);
  H5Sclose(space);
}

void write_values(hid_t file, const char* name, double first, double step) {
  std::vector<double> values(kSamples);
  for (std::size_t k = 0; k < kSamples; ++k)
    values[k] = first + step * static_cast<double>(k);
  const hid_t variable = H5Dopen2(file, name, H5P_DEFAULT);
  H5Dwrite(variable, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
           values.data());
  H5Dclose(variable);
}

void set_text(hid_t file, const char* owner, const char* name,
              const std::string& text) {
  H5Adelete_by_name(file, owner, name, H5P_DEFAULT);
  const hid_t object = H5Oopen(file, owner, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size());
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute =
      H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, text.data());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Oclose(object);
}

TEST_F(Hdf5Rejection, MissingFilesAndDirectories) {
  fs::remove(file);
  EXPECT_EQ(rejected(), "cannot read: No such file or directory");
  EXPECT_EQ(
      rejection([&] { read_recording(::testing::TempDir()); }),
      ::testing::TempDir() + ": not a file; expected a recording of beamgyro");
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
  damage([](hid_t) {});  // HDF5 drops the checksum of what it may change
  fs::resize_file(file, fs::file_size(file) - 1);
  EXPECT_TRUE(holds(rejected(), "truncated file"));
}

TEST_F(Hdf5Rejection, OtherFiletypes) {
  damage([](hid_t id) { set_text(id, "/", "filetype", "beamgyro-other"); });
  const std::string expected =
      "not a recording of beamgyro; expected the attribute filetype = "
      "\"beamgyro-recording\"";
  EXPECT_EQ(rejected(), expected);
  damage([](hid_t id) { H5Adelete(id, "filetype"); });
  EXPECT_EQ(rejected(), expected);
}

TEST_F(Hdf5Rejection, NewerFormats) {
  damage([](hid_t id) {
    const int version = 3;
    const hid_t attribute = H5Aopen(id, "format_version", H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_INT, &version);
    H5Aclose(attribute);
  });
  EXPECT_EQ(rejected(),
            "format_version 3 is not known; this program reads up to 2");
}

TEST_F(Hdf5Rejection, MissingAttributes) {
  damage([](hid_t id) {
    H5Adelete_by_name(id, "temperature", "role", H5P_DEFAULT);
  });
  EXPECT_EQ(rejected(), "temperature has no attribute role");
  damage([](hid_t id) { H5Adelete(id, "seed"); });
  EXPECT_EQ(rejected(), "the file has no attribute seed");
}

TEST_F(Hdf5Rejection, UnknownRoles) {
  damage([](hid_t id) { set_text(id, "/output", "role", "guess"); });
  EXPECT_EQ(rejected(),
            "output has the role 'guess'; expected measured, truth or "
            "compensated");
}

TEST_F(Hdf5Rejection, MissingTimeOrStatus) {
  damage([](hid_t id) { H5Ldelete(id, "status", H5P_DEFAULT); });
  EXPECT_TRUE(rejected().starts_with("cannot open status: ")) << rejected();
  damage([](hid_t id) { H5Ldelete(id, "time", H5P_DEFAULT); });
  EXPECT_TRUE(rejected().starts_with("cannot open time: ")) << rejected();
}

TEST_F(Hdf5Rejection, TimesThatDoNotIncrease) {
  damage([](hid_t id) { write_values(id, "time", 1.0, 0.0); });
  EXPECT_EQ(rejected(), "time: sample 1 is 1 s, not after 1 s before it");
}

TEST_F(Hdf5Rejection, ValuesThatAreNotFinite) {
  damage([](hid_t id) { write_values(id, "true_bias", INFINITY, 0.0); });
  EXPECT_EQ(rejected(), "true_bias: sample 0 is inf; a truth is always finite");
}

TEST_F(Hdf5Rejection, ValuesWhoseSquaresOverflow) {
  damage([](hid_t id) { write_values(id, "true_bias", 1e12, 0.0); });
  EXPECT_NO_THROW(read_recording(file));
  damage([](hid_t id) { write_values(id, "true_bias", -1e300, 0.0); });
  EXPECT_EQ(rejected(),
            "true_bias: sample 0 is -1e+300; expected at most +-1e+12");
}

TEST_F(Hdf5Rejection, VariablesOfAnotherLengthOrType) {
  damage([](hid_t id) { replace(id, "status", H5T_STD_U8LE, 7); });
  EXPECT_EQ(rejected(), "status has 7 values; expected 20");
  damage([](hid_t id) { replace(id, "status", H5T_IEEE_F64LE, kSamples); });
  EXPECT_EQ(rejected(), "status has another type; expected unsigned bytes");
  damage([](hid_t id) { replace(id, "time", H5T_C_S1, kSamples); });
  EXPECT_EQ(rejected(), "time has another type; expected floating point");
}

TEST_F(Hdf5Rejection, VariablesOfTwoDimensions) {
  damage([](hid_t id) {
    H5Ldelete(id, "time", H5P_DEFAULT);
    const std::array<hsize_t, 2> size = {3, 4};
    const hid_t space = H5Screate_simple(2, size.data(), nullptr);
    H5Dclose(H5Dcreate2(id, "time", H5T_IEEE_F64LE, space, H5P_DEFAULT,
                        with_a_place(), H5P_DEFAULT));
    H5Sclose(space);
  });
  EXPECT_EQ(rejected(), "time has 2 dimensions; expected one");
}

TEST_F(Hdf5Rejection, VariablesWithoutTheirValues) {
  damage([](hid_t id) {
    H5Ldelete(id, "time", H5P_DEFAULT);
    const hsize_t huge = hsize_t{1} << 50;
    const hid_t space = H5Screate_simple(1, &huge, nullptr);
    H5Dclose(H5Dcreate2(id, "time", H5T_IEEE_F64LE, space, H5P_DEFAULT,
                        H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
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
  damage([](hid_t id) { H5Ldelete(id, "meta", H5P_DEFAULT); });
  EXPECT_EQ(read_recording(file).scenario_text, "");
}

}  // namespace
}  // namespace beamgyro::internal::hdf5_rejection_test
