// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dataset/recording.h"

namespace beamgyro {

/// Anything that answers a compensated rate [deg/s] to every sample.
using RateEstimator = std::function<std::vector<double>(const Recording&)>;

constexpr double kFullScale = 150.0;  // [deg/s], of a gyro that tells none

/// Largest rate [deg/s] the gyro measures: readout.full_scale_deg_per_s of the
/// recording's device file and overrides. Nothing without such a file.
std::optional<double> stated_full_scale(const Recording& recording);

/// Rate [deg/s] injected over hold j = 0, 1, ... of a replay,
///
///   (-1)^j `largest` 10^(-4 frac(j (sqrt(5) - 1)/2)):
///
/// of both signs, from `largest` down to a ten-thousandth of it, evenly spread
/// over the logarithm.
double held_rate(std::size_t hold, double largest);

/// What would have been measured with the rates `injected` [deg/s], one per
/// time: `rate` + Omega and `output` + S Omega, with S [V/(deg/s)] and the
/// offset recovered from the two columns themselves. Nothing when there is an
/// `output` whose S cannot be recovered, because the rate never changed. Throws
/// std::invalid_argument when `rate` is missing or not a straight line in
/// `output`.
std::optional<Recording> with_injected_rate(const Recording& recording,
                                            std::span<const double> injected);

/// A second or less of a replay over which the injected rate was held.
struct ReplayedBlock {
  double time;         // [s], of the first sample
  double temperature;  // [degC], measured; NaN in a recording without
  double rate;         // [deg/s], injected
  double retained;     // [-], share of it in the answers
};

/// Two paired replays of a run, one with rates held for 4 s, one for 600 s (in
/// a run shorter than four of those, for a quarter of it): the difference
/// between the answers with and without the injected rate, over the rate, block
/// by block. 1 to rounding for a compensator that looks at neither `output` nor
/// `rate`; drift and noise, being the same in both, cancel. Left out are
/// samples without power, within kSettlingTime after a step, and with a total
/// true rate beyond `full_scale` [deg/s]. Saturation and the limits of the
/// converter are not replayed. `answers` are the estimator's to the recording.
/// Nothing where with_injected_rate() has nothing.
std::optional<std::vector<ReplayedBlock>> replay(
    const RateEstimator& estimator, const Recording& recording,
    std::span<const double> answers, double full_scale);

/// Whether `a` is worse than `b`: no number before any; then what cancels the
/// rate, retained below kCancelledBelow, the least first; then what is farther
/// from 1.
bool is_worse(const ReplayedBlock& a, const ReplayedBlock& b);

/// The worst blocks of replays, by the injected rate: a smaller one may be off
/// by more (ScaleFactorTolerance).
struct WorstBlocks {
  std::optional<ReplayedBlock> small;  // within kSmallRate
  std::optional<ReplayedBlock> large;  // beyond

  void add(const ReplayedBlock& block);
  void add(const WorstBlocks& other);
  std::optional<ReplayedBlock> worse() const;  // of the two
};

/// The scale factor retained in the worst block of a replay. Nothing where
/// replay() has nothing, or no block.
std::optional<double> injected_scale_factor(const RateEstimator& estimator,
                                            const Recording& recording,
                                            double full_scale = kFullScale);

}  // namespace beamgyro
