// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "dataset/recording.h"

namespace beamgyro {

/// Anything that answers a compensated rate [deg/s] to every sample.
using RateEstimator = std::function<std::vector<double>(const Recording&)>;

constexpr double kInjectedRate = 1.0;  // [deg/s]

/// Rate [deg/s] injected at `time` [s] into a recording, `fraction` of its
/// length: +A, then -A, each over 0.3 of the length, then a sine of 20 s period
/// over 0.2 and a ramp from -A to A over the rest.
double injected_rate(double fraction, double time, double amplitude);

/// The recording as it would have been with the injected rate: `rate` + Omega
/// and `output` + S Omega, with S [V/(deg/s)] and the offset recovered from the
/// two columns themselves. Nothing when there is an `output` whose S cannot be
/// recovered, because the rate never changed. Throws std::invalid_argument when
/// `rate` is missing or not a straight line in `output`.
std::optional<Recording> with_injected_rate(const Recording& recording,
                                            double amplitude = kInjectedRate);

/// Scale factor retained by a paired replay of a run: the least-squares slope,
/// over the injected rate, of the difference between the answers with and
/// without it. 1 to rounding for a compensator that looks at neither `output`
/// nor `rate`; drift and noise, being the same in both, cancel. Saturation and
/// the limits of the converter are not replayed. Nothing where
/// with_injected_rate() has nothing or there are no two powered samples.
std::optional<double> injected_scale_factor(const RateEstimator& estimator,
                                            const Recording& recording,
                                            double amplitude = kInjectedRate);

}  // namespace beamgyro
