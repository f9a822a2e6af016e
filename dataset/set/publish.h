// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace beamgyro {

/// Puts `bytes` under `path`, all of them or none: written under a partial name
/// beside it, on the disk, read back and compared, renamed, and the name on the
/// disk, too. Throws as AtomicFile for a wrong place; std::runtime_error that
/// names the path, the bytes needed and, if the disk is full, those free there.
void publish_file(const std::filesystem::path& path,
                  std::span<const std::byte> bytes);

/// That entries of `directory` are on the disk. Throws std::runtime_error.
void sync_directory(const std::filesystem::path& directory);

}  // namespace beamgyro
