// SPDX-License-Identifier: MIT
#include "dataset/files/file_place.h"

#include <algorithm>
#include <system_error>

namespace beamgyro::internal {

namespace fs = std::filesystem;

fs::path canonical_place(const fs::path& path) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(fs::absolute(path), error);
  if (error) place = fs::absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

bool is_within(const fs::path& place, const fs::path& other) {
  return std::mismatch(place.begin(), place.end(), other.begin(), other.end())
             .second == other.end();
}

}  // namespace beamgyro::internal
