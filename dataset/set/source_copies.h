// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "include/beamgyro/device.h"

namespace beamgyro::internal {

using SourceText = beamgyro::InputFile;

/// Returns the names of the copies of `files` in a set, below source/. The
/// copies are placed to each other as the originals are, so that relative paths
/// in them stay valid. There is one entry for each file, in order; a file that
/// comes twice has one. Throws std::invalid_argument for a name that is not
/// UTF-8.
std::vector<SourceEntry> source_entries(std::span<const SourceText> files);

/// Makes the copies that are not there yet. Throws as publish_file().
void copy_sources(const std::filesystem::path& directory,
                  std::span<const SourceText> files);

/// Reads the copies that `head` lists. Throws std::runtime_error naming one
/// that is missing or has other bytes.
std::vector<SourceText> read_copies(const std::filesystem::path& directory,
                                    const ManifestHead& head);

/// Restores copies that are missing or damaged from the texts in complete files
/// of the set. A profile is in none of them and stays lost. `manifest` must
/// have a head.
void restore_copies(const std::filesystem::path& directory,
                    const Manifest& manifest);

/// Returns the copy of the file that another one names as `path`. If that is a
/// place outside of the set, it is the copy that shares most of its last
/// directories. Throws std::invalid_argument when there is none, or more than
/// one.
const SourceText& copy_of(const std::filesystem::path& path,
                          std::span<const SourceText> copies);

}  // namespace beamgyro::internal
