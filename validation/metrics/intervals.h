// SPDX-License-Identifier: MIT
#pragma once

#include "validation/metrics/metric.h"

namespace beamgyro::internal {

constexpr double kIntervalTail = 0.025;  // [-], on each side of an interval

/// Returns the 95 % interval of Clopper and Pearson for the probability of a
/// success that was seen `successes` times in `trials`, more than 0. Neither
/// has to be a whole number.
Interval clopper_pearson(double successes, double trials);

/// Returns the half-width of a 95 % interval of a mean, in standard errors that
/// were estimated with so many degrees of freedom: Student's t.
double student_half_width(double freedom);

}  // namespace beamgyro::internal
