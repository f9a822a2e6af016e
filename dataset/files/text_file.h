// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace beamgyro::internal {

/// Returns the bytes of a file. Throws std::invalid_argument naming the file
/// when it is missing, a directory or not readable, and FileError when reading
/// fails.
std::string read_text_file(const std::filesystem::path& path);

/// Reads the same piece by piece, for a file that may be larger than memory.
void read_in_pieces(const std::filesystem::path& path,
                    const std::function<void(std::string_view)>& take);

}  // namespace beamgyro::internal
