// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "planning/chamber_time.h"

namespace beamgyro::internal {

/// Returns the text of a scenario file that takes a device through the soaks:
/// from the start at time 0, powered, over the shortest way, in a stirred
/// chamber, at rest. `device` is the device file as the scenario names it. A
/// comment has the times for who operates a chamber.
std::string schedule_text(const std::vector<double>& soaks,
                          const ChamberTime& time, const std::string& device);

}  // namespace beamgyro::internal
