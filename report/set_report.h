// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace beamgyro::internal {

/// Describes the contents of a file of a set; nothing for any other file. Adds
/// a warning to `warnings` for one that no manifest knows.
std::optional<std::string> info_on_shard(const std::filesystem::path& path,
                                         std::vector<std::string>& warnings);
/// Describes the directory of a set. Throws std::invalid_argument for any
/// other.
std::string info_on_set(const std::filesystem::path& path);

/// Returns the KEY=VALUE lines that turn the base device into device number
/// `device`, and the scenarios into its runs. They are computed from the copy
/// of the campaign in the set.
std::string info_on_device(const std::filesystem::path& path,
                           std::uint32_t device);

}  // namespace beamgyro::internal
