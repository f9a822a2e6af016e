// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dataset/log/log_map.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

constexpr double kFastestDrift = 1.0;  // [K/s] of a gyro

/// Fast changes of a temperature: those of the row `row` in a stretch of
/// `elapsed` s before it, and of all such stretches together.
struct FastDrift {
  std::size_t row;         // at the end of the fastest stretch
  double change, elapsed;  // [K], [s] of that stretch
  double total;            // [K] of all fast stretches
};

/// Returns the fast changes of a temperature T when they mean a wrong unit of
/// time: when T spans 10 K or more, and they are 5 K or more together and at
/// least a quarter of all that T changes. A stretch is fast when T changes in
/// it by more than kFastestDrift and by
///   D = max(0.5 K, 3 x smallest step of T (1 K at most), 10 x noise)
/// or more. T is smoothed by medians over five rows, over three at both ends,
/// so that a bad value is none. Neither is a step between two rows that is
/// alone, where logs of several soaks were joined, unless the whole log is too
/// short for its span. The noise comes from the
/// median of what the smoothing takes off. NaN are left out.
std::optional<FastDrift> fast_drift(std::span<const double> time,
                                    std::span<const double> temperature);

/// Throws std::invalid_argument for a recording whose unit of time cannot be
/// right: for fast_drift(), unless the rules keep it or the temperature comes
/// from a log that is joined, and for a log of more than five years. `lines`
/// are those of its rows in the log called `path`.
void check_time_unit(const Recording& recording,
                     const std::vector<std::size_t>& lines, const LogMap& map,
                     const std::string& path);

}  // namespace beamgyro::internal
