// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Where a soak was reached from: from below, or from above.
enum class Direction { kNone, kUp, kDown };

/// The end of a time at constant ambient temperature.
struct Soak {
  SampleRange range;  // its last five minutes
  double ambient;     // [degC]; the measured temperature without one
  Direction reached = Direction::kNone;  // none: the first one
};

/// Returns the soaks of ten minutes or more: ranges of constant ambient
/// temperature, or in a recording without one those whose measured temperature
/// no longer moves from minute to minute.
std::vector<Soak> soaks_of(const Recording& recording);

/// Returns the samples of each.
std::vector<SampleRange> ranges_of(const std::vector<Soak>& soaks);

}  // namespace beamgyro::internal
