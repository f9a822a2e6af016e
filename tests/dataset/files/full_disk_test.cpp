// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "dataset/files/text_file.h"
#include "dataset/netcdf/hdf5_exit.h"
#include "dataset/netcdf/recording_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::full_disk_test {
namespace {

namespace fs = std::filesystem;

// As the program does, before any other test uses HDF5.
[[maybe_unused]] const bool kKeptOpen = (keep_hdf5_open_at_exit(), true);

constexpr std::size_t kPage = 4096;  // [bytes]

/// A file system of a few pages, seen by this process and its children only.
/// Mounting takes a superuser.
class FullDisk : public ::testing::TestWithParam<std::string>,
                 public TestDirectory {
 protected:
  void SetUp() override {
    if (unshare(CLONE_NEWNS) != 0 ||
        mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        !mount_pages(1))
      GTEST_SKIP() << "cannot mount a file system here";
    is_mounted_ = true;
  }
  void TearDown() override {
    if (is_mounted_) {
      EXPECT_EQ(umount(directory.c_str()), 0);
    }
  }

  bool mount_pages(std::size_t pages) const {
    const std::string size = "size=" + std::to_string(pages * kPage);
    return mount("tmpfs", directory.c_str(), "tmpfs",
                 is_mounted_ ? MS_REMOUNT : 0, size.c_str()) == 0;
  }
  fs::path file() const { return directory / ("run" + GetParam()); }

 private:
  bool is_mounted_ = false;
};

// Ends like a program: with what HDF5 does at the end of the process.
[[noreturn]] void write_and_exit(const Recording& recording,
                                 const fs::path& file) {
  try {
    write_recording(recording, file);
  } catch (const std::runtime_error& error) {
    std::fputs(error.what(), stderr);
    std::exit(1);
  }
  std::exit(0);
}

TEST_P(FullDisk, EndsTheProgramInOrderWhereverItStrikes) {
  const Recording recording = sample_recording(1000);
  for (std::size_t pages = 1; pages < 20; ++pages) {
    ASSERT_TRUE(mount_pages(pages));
    EXPECT_EXIT(write_and_exit(recording, file()), testing::ExitedWithCode(1),
                "run.*: cannot .*: No space left on device")
        << pages;
    EXPECT_EQ(names().size(), 0u) << pages;
  }
  ASSERT_TRUE(mount_pages(200));
  EXPECT_EXIT(write_and_exit(recording, file()), testing::ExitedWithCode(0),
              "^$");
  EXPECT_EQ(names().size(), 1u);
}

TEST_P(FullDisk, ABlockThatFailedMayComeAgain) {
  const Recording recording = sample_recording(20000);
  ASSERT_TRUE(mount_pages(100));
  RecordingFile written(recording, 20000, file());
  const std::string message =
      rejection<std::runtime_error>([&] { written.append(recording); });
  EXPECT_EQ(message,
            file().string() + ": cannot write: No space left on device");
  EXPECT_FALSE(fs::exists(file()));
  ASSERT_TRUE(mount_pages(2000));
  written.append(recording);
  written.finish();
  write_recording(recording, directory / ("whole" + GetParam()));
  EXPECT_EQ(read_text_file(file()),
            read_text_file(directory / ("whole" + GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Kinds, FullDisk, testing::Values(".h5", ".csv"));

}  // namespace
}  // namespace beamgyro::internal::full_disk_test
