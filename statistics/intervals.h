// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace beamgyro::internal {

/// The 95 % interval of a value.
struct Interval {
  double low, high;
};

constexpr double kIntervalTail = 0.025;  // [-], on each side of an interval
constexpr double kNormal975 = 1.959963984540054;  // [-], normal quantile

/// Returns the 95 % interval of Clopper and Pearson for the probability of a
/// success that was seen `successes` times in `trials`, more than 0. Neither
/// has to be a whole number.
Interval clopper_pearson(double successes, double trials);

/// Returns the half-width of a 95 % interval of a mean, in standard errors that
/// were estimated with so many degrees of freedom: Student's t. Of `count`
/// intervals each is so wide that all hold at once (Bonferroni).
double student_half_width(double freedom, std::size_t count = 1);

/// Returns the value below which a share [0, 1] of sorted values lies,
/// interpolated between neighbours. There must be one.
double percentile(const std::vector<double>& sorted, double share);

}  // namespace beamgyro::internal
