// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/metrics/metric.h"

namespace beamgyro::internal {

/// Returns the name of a metric in words without its unit, for a heading:
/// "Peak-to-peak bias".
std::string title_of(const Metric& metric);

/// Returns how far a value is from the best one, in the unit of the metric; the
/// smaller, the better. The best value is 0 for most metrics, 1 for a scale
/// factor, the stated share for a coverage. For a frequency the largest value
/// is the best, and this is the value with the other sign.
double shortfall_of(const Metric& metric, double value);

}  // namespace beamgyro::internal
