// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace beamgyro {

/// The bytes of a file. Throws std::invalid_argument naming the file when it is
/// missing, a directory or not readable.
std::string read_text_file(const std::filesystem::path& path);

}  // namespace beamgyro
