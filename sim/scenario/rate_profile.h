// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "random/random_stream.h"
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

/// Random streams of the profiles of the cross axes x, y and of the
/// accelerations along x, y, z.
inline constexpr std::array<RandomPurpose, 2> kCrossPurposes = {
    kCrossRateXStream, kCrossRateYStream};
inline constexpr std::array<RandomPurpose, 3> kAccelerationPurposes = {
    kAccelerationXStream, kAccelerationYStream, kAccelerationZStream};

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
