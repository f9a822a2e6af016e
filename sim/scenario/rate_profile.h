// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "random/random_stream.h"
#include "sim/device/case_axis.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/signal/output_filter.h"

namespace beamgyro::internal {

/// Gaussian rate of a given rms: white noise through two equal real poles w,
/// which together are -3 dB at `bandwidth`. R(t) = rms^2 e^{-w|t|}(1 + w|t|).
struct RandomRate {
  double rms;        // [rad/s]
  double bandwidth;  // [Hz]
};

/// Rate about an axis [rad/s] or acceleration along it [m/s2] over time. A sine
/// has the phase `phase` at time 0.
using RateProfile = std::variant<PiecewiseLinear, SineSignal, RandomRate>;

/// Returns whether a profile or a signal ever differs from zero.
bool moves(const RateProfile& profile);
bool moves(const Signal& signal);

/// How a motion about or along an axis is named.
struct AxisNames {
  std::string_view key;     // of its table in a scenario
  std::string_view column;  // of a recording
  RandomPurpose purpose;    // stream of a random one
};
inline constexpr PerAxis<AxisNames> kCaseAxes = {
    {{"rate", "true_rate", kRateProfileStream},
     {"cross_rate.x", "true_cross_rate_x", kCrossRateXStream},
     {"cross_rate.y", "true_cross_rate_y", kCrossRateYStream},
     {"acceleration.x", "true_acceleration_x", kAccelerationXStream},
     {"acceleration.y", "true_acceleration_y", kAccelerationYStream},
     {"acceleration.z", "true_acceleration_z", kAccelerationZStream}}};

/// Returns profiles that are 0 all the time.
PerAxis<RateProfile> no_motion();

/// Returns a signal at increasing times.
std::vector<double> values_at(const Signal& signal,
                              std::span<const double> times);

/// Draws a random rate over [0, duration]: exact samples of the process on a
/// grid of 1/(16 bandwidth) with straight lines between them, scaled so that
/// the mean square of the interpolated signal is rms^2. The numbers come from
/// the stream `purpose` of (seed, device, run).
PiecewiseLinear realised(const RandomRate& random, double duration,
                         std::uint64_t seed, std::uint32_t device,
                         std::uint32_t run,
                         RandomPurpose purpose = kRateProfileStream);

}  // namespace beamgyro::internal
