// SPDX-License-Identifier: MIT
#include "cli/recorded_runs.h"

#include <filesystem>

#include "dataset/hdf5_file.h"
#include "dataset/sha256.h"

namespace beamgyro {

RunSource runs_of_files(const std::vector<std::string>& paths) {
  return {paths.size(), [&paths](const RunSource::Visitor& visit) {
            for (const std::string& path : paths)
              visit({std::filesystem::path(path).filename().string(),
                     sha256_of_file(path), read_recording(path)});
          }};
}

}  // namespace beamgyro
