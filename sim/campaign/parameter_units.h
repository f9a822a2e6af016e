// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro::internal {

/// Returns the unit that the end of a key names, spelled as in recordings:
/// "degree/s" for "offset_trim_deg_per_s", "1" when it names none.
std::string units_of(std::string_view key);

}  // namespace beamgyro::internal
