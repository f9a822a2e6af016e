// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Times from <= t <= to [s].
struct TimeWindow {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// A signal at equal steps, divided into stretches; no difference may join two
/// of them.
struct EvenSeries {
  std::vector<std::vector<double>> stretches;  // NaN: no sample at this place
  double interval = 0.0;     // [s], mean step between neighbouring samples
  std::size_t samples = 0;   // in the stretches
  std::size_t missing = 0;   // places in the stretches without a sample
  std::size_t left_out = 0;  // samples of the recording that no stretch holds
  double first = 0.0;        // [s], time of the first sample
  double last = 0.0;         // [s], of the last one
  // [-], how far 64 steps after each other depart from the time that their
  // places span, over that time: mean of all. Jitter gives 0.03 at most.
  double unevenness = 0.0;
};

/// Puts the samples of column `name` that are powered, finite and within
/// `window` on a grid of equal steps. A step of more than 1.5 times the median
/// one is a gap, which is filled with NaN. A new stretch begins
/// - where power comes on, since the bias then has another turn-on offset;
/// - at a gap that would leave fewer than one place in four of the stretch so
///   far with a sample.
/// A single sample between two such places is left out. Throws
/// std::invalid_argument when there is no such column, or no two samples.
EvenSeries even_series(const Recording& recording, std::string_view name,
                       const TimeWindow& window = {});

}  // namespace beamgyro::internal
