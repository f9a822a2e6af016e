// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace beamgyro::internal {

/// Returns the bytes of a file. Throws std::invalid_argument naming the file
/// when it is missing, a directory or not readable, and FileError when reading
/// fails.
std::string read_text_file(const std::filesystem::path& path);

/// The largest file of JSON that is read [bytes].
inline constexpr std::size_t kLargestJson = std::size_t{16} << 20;

/// Returns the same of a file of at most kLargestJson bytes; of a larger one no
/// more is read. Throws std::invalid_argument for it, which expects `kind`,
/// such as "a compensator".
std::string read_json_text(const std::filesystem::path& path,
                           std::string_view kind);

/// Reads the same piece by piece, for a file that may be larger than memory.
void read_in_pieces(const std::filesystem::path& path,
                    const std::function<void(std::string_view)>& take);

}  // namespace beamgyro::internal
