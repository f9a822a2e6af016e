// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "random/random_stream.h"
#include "sim/signal/flicker.h"

namespace beamgyro {

/// Noise of the rate signal, IEEE-952 two-sided conventions: Allan variance
///   sigma^2(tau) = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3.
struct NoiseParameters {
  double angle_random_walk = 0.0;  // N [rad/sqrt(s)]
  double bias_instability = 0.0;   // B [rad/s]
  double rate_random_walk = 0.0;   // K [rad/s/sqrt(s)]
  double turn_on = 0.0;            // one sigma, per power cycle [rad/s]
};

/// White noise, flicker and rate random walk of one run [rad/s], one value a
/// sample at the times m / output_rate:
///   white    variance N^2 x output_rate,
///   flicker  see FlickerFilter, stationary from the start,
///   walk     0 at the first sample, steps of variance K^2 / output_rate.
/// The noise does not depend on how a run is cut into calls.
class RateNoise {
 public:
  /// Throws std::invalid_argument for a parameter below 0, an output rate [Hz]
  /// not above 0, or one not finite.
  RateNoise(const NoiseParameters& parameters, double output_rate,
            std::uint64_t seed, std::uint32_t device, std::uint32_t run);

  /// Adds the noise of the next rate.size() samples.
  void add_next(std::span<double> rate);

 private:
  double white_sigma_;  // [rad/s]
  double walk_sigma_;   // of one step [rad/s]
  double walk_ = 0.0;   // at the next sample [rad/s]
  RandomStream white_stream_;
  RandomStream walk_stream_;
  std::optional<FlickerNoise> flicker_;  // none when B = 0
};

/// Turn-on offsets [rad/s] of the first `cycles` power cycles of a run,
/// independent normals of sigma parameters.turn_on; cycle i gets the same value
/// whatever `cycles`. Throws as RateNoise.
std::vector<double> turn_on_offsets(const NoiseParameters& parameters,
                                    std::size_t cycles, std::uint64_t seed,
                                    std::uint32_t device, std::uint32_t run);

}  // namespace beamgyro
