// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dataset/recording/recording.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {

/// What answers leave of the noise of a recording at rest.
struct AllanRatio {
  // [-], overlapping Allan deviation at 1 s of the answers' residual over that
  // of the recorded one, with its 95 % interval: the jackknife over twenty
  // pieces, with Student's t, of its logarithm.
  double ratio;
  Interval interval;
  double recorded;      // [deg/s], Allan deviation at 1 s of the recorded one
  double fall;          // [-], its deviation at 4 s over that, 0.5 in white
                        // noise; NaN where no stretch has 8 s
  std::size_t seconds;  // [s], whole ones that count
};

/// Largest fall of a recorded residual that is mostly white noise; drift alone
/// does not fall.
constexpr double kWhiteNoiseFall = 0.75;  // [-]

/// Compares residuals, rate less true rate, in all powered stretches without a
/// gap in which the answers are finite. An answer belongs to the sample `lag`
/// before it. Returns nothing where 1 s is no multiple of the step, no stretch
/// has 2 s, or the recorded residual has no noise.
std::optional<AllanRatio> allan_ratio(const Recording& recording,
                                      std::span<const double> answers,
                                      std::ptrdiff_t lag = 0);

}  // namespace beamgyro::internal
