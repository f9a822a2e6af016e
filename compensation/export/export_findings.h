// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Measurements of a compensator that is exported as C, and objections to it.
struct ExportFindings {
  double difference = 0.0;              // [deg/s], firmware_difference()
  double sigma_difference = 0.0;        // [deg/s], of sigma; 0 without one
  std::vector<std::string> objections;  // why firmware should not have it
};

/// Measures a compensator. It objects to one whose firmware_difference(), of
/// rate or sigma, exceeds kLargestDifference, and to one that cancels the rate
/// (rate_kept() below kCancelledBelow). Throws as firmware_difference().
ExportFindings findings_of(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
