// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "dataset/random_stream.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/signal/output_filter.h"

namespace beamgyro {

/// Gaussian rate of given rms, white noise through two equal real poles whose
/// pair is -3 dB at `bandwidth`: R(t) = rms^2 e^{-w|t|}(1 + w|t|).
struct RandomRate {
  double rms;        // [rad/s]
  double bandwidth;  // [Hz]
};

/// Rate about an axis over time [rad/s], or acceleration along it [m/s2]. A
/// sine runs from time 0 on, with phase `phase` there.
using RateProfile = std::variant<PiecewiseLinear, SineSignal, RandomRate>;

/// Whether a profile or a signal ever differs from zero.
bool moves(const RateProfile& profile);
bool moves(const Signal& signal);

/// Streams of the random profiles of the cross axes x, y and of acceleration
/// along x, y, z.
inline constexpr std::array<RandomPurpose, 2> kCrossPurposes = {
    RandomPurpose::kCrossRateX, RandomPurpose::kCrossRateY};
inline constexpr std::array<RandomPurpose, 3> kAccelerationPurposes = {
    RandomPurpose::kAccelerationX, RandomPurpose::kAccelerationY,
    RandomPurpose::kAccelerationZ};

/// A signal at increasing times.
std::vector<double> values_at(const Signal& signal,
                              std::span<const double> times);

/// One realisation of a random rate over [0, duration]: exact samples of the
/// process on a grid of 1/(16 bandwidth), linear between, scaled so that the
/// mean square of the interpolated signal is rms^2. Numbers from the stream
/// `purpose` of (seed, device, run).
PiecewiseLinear realised(const RandomRate& random, double duration,
                         std::uint64_t seed, std::uint32_t device,
                         std::uint32_t run,
                         RandomPurpose purpose = RandomPurpose::kRateProfile);

}  // namespace beamgyro
