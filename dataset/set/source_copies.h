// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"

namespace beamgyro {

struct SourceText {
  std::filesystem::path path;
  std::string text;
};

/// Copies of `files` below directory/source/, placed to each other as the
/// originals are, so that what they name by relative paths is found again. One
/// entry for each, in order; of a file that comes twice the second is left out.
/// Throws std::invalid_argument for a name that is no UTF-8, and as
/// publish_file().
std::vector<SourceEntry> copy_sources(const std::filesystem::path& directory,
                                      std::span<const SourceText> files);

}  // namespace beamgyro
