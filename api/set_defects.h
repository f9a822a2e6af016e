// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/set/set_check.h"

namespace beamgyro::internal {

/// Returns the differences of a set from its manifest: of all bytes, and of
/// views that this program made from what they would be.
std::vector<FileDefect> set_defects(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    const CheckProgress& progress);

}  // namespace beamgyro::internal
