// SPDX-License-Identifier: MIT
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>

namespace beamgyro::internal {

/// Which file a path names, and when it was last written or moved. A file that
/// is replaced, and replaced back, has another state than before.
struct FileState {
  dev_t device = 0;
  ino_t number = 0;
  off_t size = 0;               // [bytes]
  timespec written{}, moved{};  // st_mtim, st_ctim

  bool operator==(const FileState& other) const;
};

/// Returns the state of a file, through links; of one that is not there zeros.
FileState state_of_file(const std::filesystem::path& path);

}  // namespace beamgyro::internal
