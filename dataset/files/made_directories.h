// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace beamgyro::internal {

/// Makes a directory and those above it that are missing. The destructor
/// removes those that were made and are empty, so that a failure leaves none.
class MadeDirectories {
 public:
  /// Throws as throw_file_error() when they cannot be made, and
  /// std::invalid_argument when `path` is there and is no directory.
  explicit MadeDirectories(const std::filesystem::path& path);
  ~MadeDirectories() { remove_empty(); }
  MadeDirectories(const MadeDirectories&) = delete;
  MadeDirectories& operator=(const MadeDirectories&) = delete;

 private:
  void remove_empty() noexcept;

  std::vector<std::filesystem::path> made_;  // outer ones first
};

}  // namespace beamgyro::internal
