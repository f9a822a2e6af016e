// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dataset/files/directory.h"
#include "dataset/files/open_file.h"

namespace beamgyro::internal {

// Functions for the files of a set, which may come from somebody else. Files
// are opened by their names in the directory of the set, below which no
// symbolic link is followed (Directory), and must be ordinary files. Messages
// name the file. Each function throws std::invalid_argument for a file that is
// missing or not an ordinary file, and FileError when the work on it fails.

/// Opens a file; `flags` are those of open(2).
OpenFile open_set_file(const std::filesystem::path& directory,
                       const std::filesystem::path& name, int flags);

/// Returns the bytes of a file.
std::string read_set_file(const std::filesystem::path& directory,
                          const std::filesystem::path& name);

/// Returns the SHA-256 of a file in lower-case hexadecimal digits.
std::string sha256_of_set_file(const std::filesystem::path& directory,
                               const std::filesystem::path& name);

/// Returns the facts about a file of any kind, or nothing when there is none.
std::optional<FileFacts> find_in_set(const std::filesystem::path& directory,
                                     const std::filesystem::path& name);

/// Removes unfinished files of dead writers in the directory and below source/;
/// those of any host if nobody else can be writing there.
void remove_unfinished_files(const std::filesystem::path& directory,
                             bool of_any_host);

}  // namespace beamgyro::internal
