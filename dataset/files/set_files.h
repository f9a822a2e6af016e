// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
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

/// Writes `bytes` to `name` in `directory`, all of them or none. They are
/// written under a partial name, synchronised with the disk, read back and
/// compared; then the file is renamed and the name synchronised. Directories in
/// `name` are made. No symbolic link below `directory` is followed (Directory);
/// one under the name itself is replaced. Throws as AtomicFile for a wrong
/// place. Otherwise throws std::runtime_error that names the path, the bytes
/// needed and, if the disk is full, the bytes that are free.
void publish_file(const std::filesystem::path& directory,
                  const std::filesystem::path& name,
                  std::span<const std::byte> bytes);

/// Removes unfinished files of dead writers in the directory and below source/;
/// those of any host if nobody else can be writing there.
void remove_unfinished_files(const std::filesystem::path& directory,
                             bool of_any_host);

}  // namespace beamgyro::internal
