// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace beamgyro {

/// SHA-256 (FIPS 180-4) of `bytes`, as 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

/// The same of a file's content. Throws as read_text_file().
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace beamgyro
