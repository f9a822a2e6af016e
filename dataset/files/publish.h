// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace beamgyro::internal {

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

}  // namespace beamgyro::internal
