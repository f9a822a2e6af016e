// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dataset/log/log_map.h"

namespace beamgyro::internal {

/// A step of time longer than this many median steps is a gap. The rows between
/// two gaps are a burst.
constexpr double kGapSteps = 5.0;

constexpr double kSigmaPerMad = 1.4826;  // of a normal distribution

/// Returns the median of `values`, one or more, and reorders them.
double median_of(std::vector<double>& values);

/// Returns the median of the steps of `time`, or 0 with fewer than two times.
double median_step(std::span<const double> time);

/// Returns the first row of every burst, in order, beginning with 0.
std::vector<std::size_t> burst_starts(std::span<const double> time);

/// Returns the smallest step that is not 0 between two successive values,
/// without NaN; 0 when there is none.
double smallest_step(std::span<const double> values);

/// Returns for each value whether it is an outlier by `rule`. A NaN is no
/// outlier and counts in no median. A burst of one row has no outliers.
std::vector<bool> find_outliers(std::span<const double> time,
                                std::span<const double> values,
                                const OutlierRule& rule);

}  // namespace beamgyro::internal
