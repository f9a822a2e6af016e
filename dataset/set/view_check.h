// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/set_check.h"

namespace beamgyro::internal {

/// Returns the views that differ from what write_view() makes of their files,
/// in the manifest or on the disk. It reads the first file of each run, so a
/// run with one of the `known` defects is left out. Throws as ShardFile.
std::vector<FileDefect> check_views(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    std::span<const FileDefect> known);

}  // namespace beamgyro::internal
