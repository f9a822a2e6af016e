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

namespace beamgyro {

struct SetDefect {
  std::string file;  // relative to the set
  std::string what;
  std::optional<std::uint32_t> index;  // of the file to be made again
};

/// Called with the bytes checked so far, and those there are to check.
using CheckProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// Everything in which the files of a set differ from its manifest: files that
/// are missing, of another size, of other bytes (and whose bytes those are), or
/// too many; views and source copies likewise; and lines of the manifest that
/// are damaged or missing. Looks at bytes only, never through HDF5. Empty for a
/// set that is whole and finished.
std::vector<SetDefect> check_set(const std::filesystem::path& directory,
                                 const Manifest& manifest,
                                 const CheckProgress& progress = {});

}  // namespace beamgyro
