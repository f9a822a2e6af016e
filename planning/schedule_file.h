// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planning/chamber.h"
#include "planning/soak_length.h"

namespace beamgyro::internal {

/// Returns the text of a scenario file that takes a device through the soaks:
/// from the start at time 0, powered, over the shortest way, in a stirred
/// chamber, at rest. `device` is the device file as the scenario names it. A
/// comment has the times for who operates a chamber.
std::string schedule_text(const std::vector<double>& soaks,
                          const ChamberTime& time, const RowRule& rule,
                          const std::string& device);

/// Returns hours and minutes as "1:05".
std::string clock_time(double seconds);

/// Returns "1 soak", "2 soaks" and so on.
std::string soak_count(std::size_t count);

/// Returns the rule as the table [rows] of a model file says it.
std::string rule_text(const RowRule& rule);

}  // namespace beamgyro::internal
