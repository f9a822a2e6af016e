// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/noise_coefficients.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Noise of a compensated rate at rest, from its overlapping Allan deviation.
struct RestNoise {
  NoiseCoefficients coefficients;  // with N
  // K [deg/s/sqrt(s)]: of the coefficients, or the largest one that the curve
  // leaves room for: the least of the upper 95 % limits of sqrt(3 / tau) times
  // the deviation.
  double walk = 0.0;
  bool walk_is_bound = false;
  // Time constant [s] of the first-order Gauss-Markov process whose Allan
  // deviation peaks, at 1.893 time constants, in the middle of the flicker
  // floor; without B or K there is none.
  std::optional<double> flicker_time;
  double sample_rate = 0.0;  // [Hz]
  std::size_t samples = 0;
  double duration = 0.0;          // [s]
  double temperature_span = 0.0;  // [K], of the powered samples
};

/// Returns the noise that a compensator leaves of a recording at rest. Throws
/// std::invalid_argument
/// - as compensated_rate(), even_series() and noise_coefficients();
/// - when the true rate of the recording changes;
/// - when it is too short for coefficients, or shows no angle random walk.
RestNoise rest_noise(const Compensator& compensator, const Recording& rest);

}  // namespace beamgyro::internal
