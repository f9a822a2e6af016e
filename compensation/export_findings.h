// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator.h"

namespace beamgyro {

/// What is measured of a compensator when it is exported as C.
struct ExportFindings {
  double difference = 0.0;              // [deg/s], firmware_difference()
  std::vector<std::string> objections;  // why firmware should not have it
};

/// Objects to a compensator whose firmware_difference() exceeds
/// kLargestDifference and to one that cancels the rate: whose rate_kept() is
/// below kCancelledBelow. Throws as firmware_difference().
ExportFindings findings_of(const Compensator& compensator);

}  // namespace beamgyro
