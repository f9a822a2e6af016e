// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <set>
#include <string>

namespace beamgyro::internal {

/// An empty directory, whose name has a space in it. It goes with the object.
class TestDirectory {
 public:
  TestDirectory() {
    std::filesystem::remove_all(directory);
    std::filesystem::create_directory(directory);
  }
  ~TestDirectory() { std::filesystem::remove_all(directory); }
  TestDirectory(const TestDirectory&) = delete;
  TestDirectory& operator=(const TestDirectory&) = delete;

  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
      found.insert(entry.path().filename().string());
    return found;
  }

  const std::filesystem::path directory =
      std::filesystem::path(::testing::TempDir()) /
      ("of test " + std::to_string(getpid()) + "." +
       std::to_string(directories++));

 private:
  static inline std::atomic<int> directories = 0;
};

/// A test with such a directory.
class DirectoryFixture : public ::testing::Test, public TestDirectory {};

}  // namespace beamgyro::internal
