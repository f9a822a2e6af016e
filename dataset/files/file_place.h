// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace beamgyro::internal {

/// Returns a path as an absolute one, with links followed as far as it is
/// there, and without a slash at its end.
std::filesystem::path canonical_place(const std::filesystem::path& path);

/// Whether a place is the other one or below it.
bool is_within(const std::filesystem::path& place,
               const std::filesystem::path& other);

}  // namespace beamgyro::internal
