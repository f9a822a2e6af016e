// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/device.h"

namespace beamgyro::python {

/// Files as Python has them: tuples of path and text.
using PathsAndTexts =
    std::vector<std::pair<std::filesystem::path, std::string>>;

inline std::vector<InputFile> input_files(const PathsAndTexts& files) {
  std::vector<InputFile> all;
  for (const auto& [path, text] : files) all.push_back({path, text});
  return all;
}

inline PathsAndTexts paths_and_texts(const std::vector<InputFile>& files) {
  PathsAndTexts all;
  for (const InputFile& file : files) all.emplace_back(file.path, file.text);
  return all;
}

}  // namespace beamgyro::python
