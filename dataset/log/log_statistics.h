// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "dataset/log/log_map.h"
#include "dataset/recording/recording.h"

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

/// Sampling of a recording. A step longer than kGapSteps median steps is a gap.
struct Sampling {
  double median_step = 0;  // [s]
  double jitter = 0;       // [s], rms of step - median step within bursts
  std::size_t bursts = 0;
  double longest_burst = 0;  // [s]
  double longest_gap = 0;    // [s]
};

Sampling sampling_of(const Recording& recording);

/// Range of a variable without its NaN.
struct ValueRange {
  std::size_t samples = 0;
  double low = 0, high = 0;
  double smallest_step = 0;  // between successive samples, 0: constant
};

/// Throws as column_values().
ValueRange range_of(const Recording& recording, std::string_view column);

}  // namespace beamgyro::internal
