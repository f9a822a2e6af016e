// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace beamgyro {

/// What a file of a set, or the directory of one, holds, as text. Throws
/// std::invalid_argument for anything else.
std::string info_on_shard(const std::filesystem::path& path);
std::string info_on_set(const std::filesystem::path& path);

}  // namespace beamgyro
