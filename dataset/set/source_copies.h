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

/// The copies that `head` lists, from the set. Throws std::runtime_error naming
/// one that is missing or holds other bytes.
std::vector<SourceText> read_copies(const std::filesystem::path& directory,
                                    const ManifestHead& head);

/// Makes copies anew that are missing or damaged, of the texts in whole files
/// of the set; a profile is in none of them and stays lost. `manifest` has a
/// head.
void restore_copies(const std::filesystem::path& directory,
                    const Manifest& manifest);

/// That of the file which another one names as `path`. Where that is a place
/// outside of the set the copy with most of its last directories. Throws
/// std::invalid_argument when there is none, or more than one.
const SourceText& copy_of(const std::filesystem::path& path,
                          std::span<const SourceText> copies);

}  // namespace beamgyro
