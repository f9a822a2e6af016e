// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"

namespace beamgyro::internal {

struct FileDefect {
  std::string file;  // relative to the set
  std::string what;
  std::optional<std::uint32_t> index;  // of the file to be made again
};

/// Called with the number of bytes checked so far and the number of all bytes
/// to check.
using CheckProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// Compares the files of a set with its manifest and returns the differences,
/// none for a set that is complete:
/// - files that are missing, of another size, of other bytes (and which file
///   has these bytes), or not in the manifest;
/// - the same for views and source copies;
/// - lines of the manifest that are damaged or missing.
/// It reads bytes only and does not use HDF5.
std::vector<FileDefect> check_set(const std::filesystem::path& directory,
                                  const Manifest& manifest,
                                  const CheckProgress& progress = {});

}  // namespace beamgyro::internal
