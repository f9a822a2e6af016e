// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace beamgyro {

/// What a file of a set, or the directory of one, holds, as text. Throws
/// std::invalid_argument for anything else.
std::string info_on_shard(const std::filesystem::path& path);
std::string info_on_set(const std::filesystem::path& path);

/// KEY=VALUE lines that make device number `device` of the base device, and
/// its runs of their scenarios, from the set's copy of the campaign.
std::string info_on_device(const std::filesystem::path& path,
                           std::uint32_t device);

}  // namespace beamgyro
