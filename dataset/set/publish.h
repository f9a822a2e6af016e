// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace beamgyro {

/// Puts `bytes` under `name` in `directory`, all of them or none: written under
/// a partial name beside it, on the disk, read back and compared, renamed, and
/// the name on the disk, too. Directories that `name` has are made; no symbolic
/// link below `directory` is followed (Directory), one under the name is
/// replaced. Throws as AtomicFile for a wrong place; std::runtime_error that
/// names the path, the bytes needed and, if the disk is full, those free there.
void publish_file(const std::filesystem::path& directory,
                  const std::filesystem::path& name,
                  std::span<const std::byte> bytes);

}  // namespace beamgyro
