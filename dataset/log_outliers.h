// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dataset/log_map.h"

namespace beamgyro {

/// A step of time longer than this many usual steps is a gap; the rows between
/// two gaps are a burst.
constexpr double kGapSteps = 5.0;

/// Median of the steps of `time`; 0 with fewer than two times.
double median_step(std::span<const double> time);

/// First row of every burst, in order; the first one is 0.
std::vector<std::size_t> burst_starts(std::span<const double> time);

/// Smallest step that is not 0 between two successive values, NaN left out; 0
/// when there is none.
double smallest_step(std::span<const double> values);

/// Whether each value is an outlier by `rule`. A NaN is none and counts in no
/// median; neither does a burst of one row have any.
std::vector<bool> find_outliers(std::span<const double> time,
                                std::span<const double> values,
                                const OutlierRule& rule);

}  // namespace beamgyro
