// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/rate_injection.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

constexpr double kSweepStep = 0.02;  // [K]

/// Makes a recording of a gyro like that of `recording` at rest, with one
/// sample a second while the temperature rises through `range` (within -100 and
/// 200 degC) in steps of kSweepStep. Every other measured column has its mean,
/// the rate to 0.01 deg/s, and the output belongs to that rate.
Recording temperature_sweep(const Recording& recording,
                            const TemperatureRange& range);

/// Replays of a sweep, each starting one held_rate() later: at every
/// temperature both signs of rates that lie a factor of 1.7 or less apart.
constexpr std::size_t kSweepReplays = 64;

/// Returns the worst blocks of the replays of that sweep with rates up to
/// `full_scale` [deg/s]. It tests temperatures between those of the recorded
/// samples. The scale-factor table is left out. Returns nothing for a
/// compensator whose inputs do not see the rate, and where replay() returns
/// nothing.
WorstBlocks worst_over_temperature(const Compensator& compensator,
                                   const Recording& recording,
                                   double full_scale);

}  // namespace beamgyro::internal
