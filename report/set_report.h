// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/set/set_writer.h"

namespace beamgyro::internal {

/// Returns whether the manifest in the directory of a file lists it.
bool is_listed_in_set(const std::filesystem::path& path);

/// Describes the contents of a file of a set, or of the directory of a set.
/// Adds a warning to `warnings` for a file that no manifest knows. Throws
/// std::invalid_argument for anything else.
std::string info_on_shard(const std::filesystem::path& path,
                          std::vector<std::string>& warnings);
std::string info_on_set(const std::filesystem::path& path);

/// Returns the KEY=VALUE lines that turn the base device into device number
/// `device`, and the scenarios into its runs. They are computed from the copy
/// of the campaign in the set.
std::string info_on_device(const std::filesystem::path& path,
                           std::uint32_t device);

}  // namespace beamgyro::internal
