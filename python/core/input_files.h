// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "include/beamgyro/device.h"

namespace beamgyro::python {

/// Files as Python has them: tuples of path and bytes. A profile may be in
/// another encoding than UTF-8.
using PathsAndTexts =
    std::vector<std::pair<std::filesystem::path, pybind11::bytes>>;

inline std::vector<InputFile> input_files(const PathsAndTexts& files) {
  std::vector<InputFile> all;
  for (const auto& [path, text] : files) all.push_back({path, text});
  return all;
}

inline PathsAndTexts paths_and_texts(const std::vector<InputFile>& files) {
  PathsAndTexts all;
  for (const InputFile& file : files)
    all.emplace_back(file.path, pybind11::bytes(file.text));
  return all;
}

}  // namespace beamgyro::python
