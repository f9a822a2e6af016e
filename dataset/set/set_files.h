// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dataset/directory.h"
#include "dataset/open_file.h"

namespace beamgyro {

// A set may come from somebody else. Its files are opened by their names in the
// directory of the set, below which no symbolic link is followed (Directory),
// and are ordinary files. Failures name the file; all throw
// std::invalid_argument for what is missing or no ordinary file, FileError when
// the work on it fails.

/// `flags` as of open(2).
OpenFile open_set_file(const std::filesystem::path& directory,
                       const std::filesystem::path& name, int flags);

/// The bytes of one.
std::string read_set_file(const std::filesystem::path& directory,
                          const std::filesystem::path& name);

/// In lowercase hexadecimal digits.
std::string sha256_of_set_file(const std::filesystem::path& directory,
                               const std::filesystem::path& name);

/// Nothing when there is none, whatever it is.
std::optional<FileFacts> find_in_set(const std::filesystem::path& directory,
                                     const std::filesystem::path& name);

/// Removes files that writers which are dead left unfinished in the directory
/// and below source/; of any host if nobody else can be writing there.
void remove_unfinished_files(const std::filesystem::path& directory,
                             bool of_any_host);

}  // namespace beamgyro
