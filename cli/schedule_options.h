// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/soak_plan.h"

namespace beamgyro::internal {

/// Reads LOW:HIGH in degC. Throws std::invalid_argument "--option TEXT: what is
/// wrong; what would be right".
std::pair<double, double> temperature_range(const std::string& option,
                                            const std::string& text);

/// Reads the schedules that --candidates names: each word is a list of
/// temperatures between commas, or a file with such a list on each line, where
/// # begins a comment. Throws std::invalid_argument for a word or a line that
/// is no such list, for soaks beyond the chamber, and for soaks that are closer
/// together than kPointWidth.
std::vector<std::vector<double>> candidate_schedules(
    const std::vector<std::string>& words, const TemperatureRange& chamber);

}  // namespace beamgyro::internal
