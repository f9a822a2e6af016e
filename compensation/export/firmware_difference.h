// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Sample periods [s] at which firmware_difference() compares.
constexpr float kComparedPeriods[] = {0.0005f, 0.01f, 0.1f, 1.0f, 20.0f};

/// Largest difference that exported code may have [deg/s].
constexpr double kLargestDifference = 1e-4;

/// Returns the largest differences [deg/s] between FirmwareModel in single
/// precision and compensated_rate() in double precision, over 20,000 samples at
/// each of kComparedPeriods. The samples are in the range of training:
///
/// - temperatures that rise and fall between the ends of its range in eight
///   power cycles, as fast as its inputs temperature_rate() saw in training, or
///   10 K/min without one, and down to 3 % of that;
/// - rates within 150 deg/s, and other signals within their scales.
///
/// Samples are rounded to single precision for the firmware only. Throws
/// std::invalid_argument for an input other than the temperature whose scale
/// does not give its range (a polynomial with normalised = false), for answers
/// that are not finite in single precision, and as FirmwareModel.
struct FirmwareDifference {
  double rate = 0.0;   // [deg/s]
  double sigma = 0.0;  // [deg/s], from compensated_rate_sigma(), likewise
};
FirmwareDifference firmware_differences(const FittedCompensator& compensator);

/// Returns the difference of the rate.
double firmware_difference(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
