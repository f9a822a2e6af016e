// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Returns the key of KEY=VALUE, without the blanks around it.
std::string_view key_of_override(std::string_view text);

/// Returns `first` without those whose keys `later` replaces, then `later`.
std::vector<std::string> merged_overrides(
    const std::vector<std::string>& first,
    const std::vector<std::string>& later);

}  // namespace beamgyro::internal
