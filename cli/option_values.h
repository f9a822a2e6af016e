// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/range.h"

namespace beamgyro::internal {

// Each function reads the value of an option. It throws std::invalid_argument
// "--option VALUE: what is wrong; what would be right" for any other text.

/// Reads a whole number in [low, high].
long whole_number(const std::string& option, const std::string& text, long low,
                  long high);

/// Reads a seed of a validation; "random" is one of the operating system.
std::uint64_t seed_or_random(const std::string& option,
                             const std::string& text);

double decimal_number(const std::string& option, const std::string& text,
                      const Range& range);

/// Returns `text`, which must be one of `allowed`.
std::string one_of(const std::string& option, const std::string& text,
                   const std::vector<std::string>& allowed);

/// Reads LOW:HIGH in degC.
std::pair<double, double> temperature_range(const std::string& option,
                                            const std::string& text);

/// Returns the numbers between `separator`, with or without blanks around them,
/// or none when one is no number.
std::vector<double> numbers_between(const std::string& text, char separator);

}  // namespace beamgyro::internal
