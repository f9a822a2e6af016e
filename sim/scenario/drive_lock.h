// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/loop_electronics.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

inline constexpr double kLockTime = 1.0;               // [s] after power-on
inline constexpr double kAmplitudeErrorLocked = 0.01;  // of the set value
inline constexpr double kPhaseErrorLocked = 0.02;      // [rad]

/// Whether the loops hold amplitude and phase, with voltage to spare.
bool is_locked(const DriveSignals& drive);

/// Whether the loops must have locked by now: kLockTime after a power-on.
bool lock_is_due(const Scenario& scenario, double t);

/// Where the power switches and where locking is due.
std::vector<Border> power_borders(const Scenario& scenario);

/// Throws SimulationFailure that says what the loops do unless they have
/// locked; `t` [s] now, `beam` its temperature [K].
void require_locked(const DriveSignals& drive, double t, double beam);

}  // namespace beamgyro
