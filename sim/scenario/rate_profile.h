// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "sim/numerics/piecewise_linear.h"
#include "sim/signal/output_filter.h"

namespace beamgyro {

/// Gaussian rate of given rms, white noise through two equal real poles whose
/// pair is -3 dB at `bandwidth`: R(t) = rms^2 e^{-w|t|}(1 + w|t|).
struct RandomRate {
  double rms;        // [rad/s]
  double bandwidth;  // [Hz]
};

/// Rate about an axis over time [rad/s]. A sine runs from time 0 on, with
/// phase `phase` there.
using RateProfile = std::variant<PiecewiseLinear, SineSignal, RandomRate>;

/// One realisation of a random rate over [0, duration]: exact samples of the
/// process on a grid of 1/(16 bandwidth), linear between, scaled so that the
/// mean square of the interpolated signal is rms^2. Numbers from the stream
/// kRateProfile of (seed, device, run).
PiecewiseLinear realised(const RandomRate& random, double duration,
                         std::uint64_t seed, std::uint32_t device,
                         std::uint32_t run);

/// The rate and what the output filter makes of it at the sample times.
struct SampledRate {
  std::vector<double> rate;      // [rad/s]
  std::vector<double> filtered;  // [rad/s]
};
SampledRate sampled_rate(const RateProfile& profile, const OutputFilter& filter,
                         std::span<const double> times, double output_rate,
                         double duration, std::uint64_t seed,
                         std::uint32_t device, std::uint32_t run);

}  // namespace beamgyro
