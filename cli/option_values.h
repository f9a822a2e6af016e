// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "config/range.h"

namespace beamgyro::internal {

// Each function reads the value of an option. It throws std::invalid_argument
// "--option VALUE: what is wrong; what would be right" for any other text.

/// Reads a whole number in [low, high].
long whole_number(const std::string& option, const std::string& text, long low,
                  long high);

double decimal_number(const std::string& option, const std::string& text,
                      const Range& range);

/// Returns `text`, which must be one of `allowed`.
std::string one_of(const std::string& option, const std::string& text,
                   const std::vector<std::string>& allowed);

}  // namespace beamgyro::internal
