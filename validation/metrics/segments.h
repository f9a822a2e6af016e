// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

constexpr double kNoTolerance = 1e-9;  // of a value that is held

/// A stretch of samples whose mean is used, of one run.
struct Segment {
  SampleRange samples;
  double time = 0.0;         // [s], mean
  double length = 0.0;       // [s], samples times the step
  double temperature = 0.0;  // [degC], mean measured one; NaN without
  double powered = 0.0;      // [s], mean time since power-on
  std::size_t power_on = 0;  // number of the power-on
};

/// Returns the mean, summed in order.
double mean_of(std::span<const double> values);

/// Returns a segment for each range. A range lies in one powered stretch.
std::vector<Segment> segments_of(const Recording& recording,
                                 std::span<const SampleRange> ranges);

/// Returns judged rate less true rate [deg/s], one per time.
std::vector<double> residual_of(const EvidenceRun& run);

/// Returns the mean of `values` over each segment.
std::vector<double> means_over(std::span<const Segment> segments,
                               std::span<const double> values);

/// Returns the longest powered ranges over which every one of `columns` is
/// constant to kNoTolerance.
std::vector<SampleRange> held_ranges(
    const Recording& recording,
    std::span<const std::vector<double>* const> columns);

/// Returns the part of a range from `settling` [s] after its first sample.
SampleRange settled(const Recording& recording, SampleRange range,
                    double settling);

}  // namespace beamgyro::internal
