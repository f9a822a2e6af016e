// SPDX-License-Identifier: MIT
#include "dataset/files/file_state.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::file_state_test {
namespace {

TEST(FileState, AFileThatWasSwappedAndSwappedBackIsAnother) {
  const TestDirectory directory;
  const auto file = directory.directory / "a",
             other = directory.directory / "b";
  std::ofstream(file) << "one";
  std::ofstream(other) << "two";
  const FileState before = state_of_file(file);
  EXPECT_EQ(before, state_of_file(file));
  // The clock of a file system ticks every few milliseconds.
  for (int tries = 0; tries < 100000; ++tries) {
    std::filesystem::rename(file, directory.directory / "c");
    std::filesystem::rename(other, file);
    std::filesystem::rename(file, other);
    std::filesystem::rename(directory.directory / "c", file);
    if (state_of_file(file) != before) return;
  }
  FAIL() << "the file still has the state it had before";
}

TEST(FileState, OfAFileThatIsNotThereIsZero) {
  EXPECT_EQ(state_of_file("/nowhere/at/all"), FileState{});
}

}  // namespace
}  // namespace beamgyro::internal::file_state_test
