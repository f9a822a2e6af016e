// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "compensation/inputs/features.h"
#include "compensation/scoring/rate_injection.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

constexpr double kSweepStep = 0.02;  // [K]

/// How long a step of a sweep takes: moving, as a gyro that warms up, and so
/// slow that whatever lags behind the temperature arrives.
constexpr double kSweepPeriod = 1.0;    // [s]
constexpr double kSettledPeriod = 1e6;  // [s]

/// Makes a recording of a gyro like that of `recording` at rest, with one
/// sample every `period` [s] while the temperature rises through `range`
/// (within -100 and 200 degC) in steps of kSweepStep, and falls back. Every
/// other measured column has its mean,
/// the rate to 0.01 deg/s, and the output belongs to that rate.
Recording temperature_sweep(const Recording& recording,
                            const TemperatureRange& range,
                            double period = kSweepPeriod);

/// Replays of a sweep, each starting one held_rate() later: at every
/// temperature both signs of rates that lie a factor of 2 or less apart.
constexpr std::size_t kSweepReplays = 64;

/// The same for a program of the user: a process for each is slow.
constexpr std::size_t kSweepReplaysOfProgram = 2;

/// Returns the blocks of `replays` replays of that sweep with rates up to
/// `full_scale` [deg/s], of `period`. It tests temperatures between those of
/// the recorded samples. Returns none where replay() returns nothing.
std::vector<ReplayedBlock> replays_over_temperature(
    const RateEstimator& estimator, const Recording& recording,
    const TemperatureRange& range, double full_scale, std::size_t replays,
    const ReplayPauses& pauses, double period = kSweepPeriod);

}  // namespace beamgyro::internal
