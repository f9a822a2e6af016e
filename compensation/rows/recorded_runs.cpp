// SPDX-License-Identifier: MIT
#include "compensation/rows/recorded_runs.h"

#include <filesystem>
#include <stdexcept>

#include "config/file_error.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {

RunSource runs_of_files(
    const std::vector<std::string>& paths,
    const std::function<Recording(const std::filesystem::path&)>& read) {
  return {paths.size(), [&paths, read](const RunSource::Visitor& visit) {
            for (const std::string& path : paths)
              visit({std::filesystem::path(path).filename().string(),
                     sha256_of_file(path), read(path)});
          }};
}

bool is_set(const std::vector<std::string>& paths) {
  for (const std::string& path : paths)
    if (std::filesystem::is_directory(status_of(path))) {
      if (paths.size() == 1) return true;
      throw std::invalid_argument(path +
                                  ": a directory among recordings; expected "
                                  "recordings, or the directory of one set");
    }
  return false;
}

}  // namespace beamgyro::internal
