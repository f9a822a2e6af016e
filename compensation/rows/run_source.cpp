// SPDX-License-Identifier: MIT
#include "compensation/rows/run_source.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <system_error>

#include "config/file_error.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {

RunSource source_of(const std::vector<TrainingRun>& runs) {
  return {runs.size(), [&runs](const RunSource::Visitor& visit) {
            for (const TrainingRun& run : runs) visit(run);
          }};
}

RunSource runs_of_files(
    const std::vector<std::string>& paths,
    const std::function<Recording(const std::filesystem::path&)>& read) {
  return {paths.size(), [&paths, read](const RunSource::Visitor& visit) {
            for (const std::string& path : paths)
              visit({std::filesystem::path(path).filename().string(),
                     sha256_of_file(path), read(path)});
          }};
}

void require_different_runs(const std::vector<std::string>& paths) {
  std::map<std::uintmax_t, std::vector<std::string>> of_size;  // [bytes]
  for (const std::string& path : paths) {
    std::error_code error;  // shows when the run is read
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error) of_size[size].push_back(path);
  }
  for (const auto& [size, names] : of_size) {
    std::map<std::string, std::string> of_hash;
    if (names.size() < 2) continue;
    for (const std::string& name : names) {
      const auto [same, is_new] = of_hash.emplace(sha256_of_file(name), name);
      if (!is_new)
        throw std::invalid_argument(
            fmt::format("{}: is the same recording as {}; expected each once: "
                        "leave one of them out",
                        name, same->second));
    }
  }
}

}  // namespace beamgyro::internal
