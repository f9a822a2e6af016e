// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/compensator.h"
#include "compensation/rate_injection.h"
#include "dataset/recording.h"

namespace beamgyro {

constexpr double kSweepStep = 0.02;  // [K]

/// A gyro like that of `recording` at rest, a sample each second while its
/// temperature rises through `range` (within -100 and 200 degC) in steps of
/// kSweepStep. Every other measured column is at its mean, the rate within
/// 0.01 deg/s, and the output where it belongs to that rate.
Recording temperature_sweep(const Recording& recording,
                            const TemperatureRange& range);

/// The worst blocks of a replay of that sweep, up to `full_scale` [deg/s]: what
/// a compensator does at temperatures between those of the recorded samples.
/// The scale-factor table is left out. Nothing for a compensator whose inputs
/// do not see the rate, and as replay().
WorstBlocks worst_over_temperature(const Compensator& compensator,
                                   const Recording& recording,
                                   double full_scale);

}  // namespace beamgyro
