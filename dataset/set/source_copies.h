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

/// Names that copies of `files` have in a set, below source/, placed to each
/// other as the originals are, so that what they name by relative paths is
/// found again. One entry for each, in order; of a file that comes twice the
/// second is left out. Throws std::invalid_argument for a name that is no
/// UTF-8.
std::vector<SourceEntry> source_entries(std::span<const SourceText> files);

/// Makes the copies, where they are not there yet. Throws as publish_file().
void copy_sources(const std::filesystem::path& directory,
                  std::span<const SourceText> files);

}  // namespace beamgyro
