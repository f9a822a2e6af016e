// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

namespace beamgyro::internal {

/// Returns the decimal number that a text is, perhaps with one sign before it:
/// infinite where it is larger than a double holds, zero where it is smaller.
/// nan and inf are numbers. Nothing for any other text.
std::optional<double> number_in(std::string_view text);

}  // namespace beamgyro::internal
