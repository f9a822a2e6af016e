// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro {

/// Unit that the end of a key names, as recordings write it: degree/s of
/// "offset_trim_deg_per_s"; "1" when it names none.
std::string units_of(std::string_view key);

}  // namespace beamgyro
