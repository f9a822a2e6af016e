// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "compensation/scoring/scale_factor.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A function that returns the compensated rate [deg/s] of every sample.
using RateEstimator = std::function<std::vector<double>(const Recording&)>;

constexpr double kFullScale = 150.0;  // [deg/s], of a gyro that tells none

/// Returns the largest rate [deg/s] that the gyro measures:
/// readout.full_scale_deg_per_s of the device file and overrides of the
/// recording, or nothing without such a file.
std::optional<double> stated_full_scale(const Recording& recording);

/// Returns a number that depends on every rate of a recording, so that nobody
/// can tell it who sees the recording with unknown rates added.
std::uint64_t hidden_number(const Recording& recording);

/// Returns the rate [deg/s] that is injected over hold j = 0, 1, ... of a
/// replay: `largest` over hold 0, then
///
///   (-1)^j `largest` 10^(-4 frac(a + b_j + j (sqrt(5) - 1)/2)):
///
/// of both signs, from `largest` down to a ten-thousandth of it, evenly spread
/// over the logarithm. The hidden number decides a in (0, 1) and b_j, within
/// 0.008 of 0. Who knew the rates could take them off a replay, eat what is
/// left as in the recording itself, and put them back.
double held_rate(std::size_t hold, double largest, std::uint64_t hidden);

/// Returns what would have been measured with the rates `injected` [deg/s], one
/// for each time: `rate` + Omega and `output` + S Omega. S [V/(deg/s)] and the
/// offset are recovered from the two columns. Returns nothing when there is an
/// `output` whose S cannot be recovered, because the rate never changed. Throws
/// std::invalid_argument when `rate` is missing or not a straight line in
/// `output`.
std::optional<Recording> with_injected_rate(const Recording& recording,
                                            std::span<const double> injected);

/// How an estimator that filters answers may be replayed.
struct ReplayPauses {
  double settling = kSettlingTime;  // [s] after a step that is not judged
  double quiet = 0.0;  // [s] after each power-on to which nothing is added
};

/// Sets to zero what is added up to `quiet` [s] after the begin of a recording
/// and after each power-on.
void quieten(const Recording& recording, double quiet,
             std::vector<double>& added);

/// A block of a replay, one second or less, over which the injected rate was
/// constant.
struct ReplayedBlock {
  double time;         // [s], of the first sample
  double temperature;  // [degC], measured; NaN in a recording without
  double rate;         // [deg/s], injected
  double retained;     // [-], share of it in the answers
};

/// Replays a run twice, with rates held for 4 s and with rates held for 600 s
/// (or for a quarter of a run that is shorter than four of those). Returns for
/// each block the difference between the answers with and without the injected
/// rate, divided by the rate. Drift and noise are the same in both and cancel,
/// so the result is 1 to rounding for a compensator that uses neither `output`
/// nor `rate`.
/// - `answers` are those of the estimator to the recording.
/// - Left out are samples without power, within the pauses, and with a total
///   true rate beyond `full_scale` [deg/s]. Holds last twice the settling time
///   at least.
/// - Saturation and the limits of the converter are not replayed.
/// - The first hold injects held_rate(`first_hold`).
/// Returns nothing where with_injected_rate() returns nothing.
std::optional<std::vector<ReplayedBlock>> replay(
    const RateEstimator& estimator, const Recording& recording,
    std::span<const double> answers, double full_scale,
    std::size_t first_hold = 0, const ReplayPauses& pauses = {});

}  // namespace beamgyro::internal
