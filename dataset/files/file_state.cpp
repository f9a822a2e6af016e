// SPDX-License-Identifier: MIT
#include "dataset/files/file_state.h"

namespace beamgyro::internal {
namespace {

bool same_time(const timespec& one, const timespec& other) {
  return one.tv_sec == other.tv_sec && one.tv_nsec == other.tv_nsec;
}

}  // namespace

bool FileState::operator==(const FileState& other) const {
  return device == other.device && number == other.number &&
         size == other.size && same_time(written, other.written) &&
         same_time(moved, other.moved);
}

FileState state_of_file(const std::filesystem::path& path) {
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {found.st_dev, found.st_ino, found.st_size, found.st_mtim,
          found.st_ctim};
}

}  // namespace beamgyro::internal
