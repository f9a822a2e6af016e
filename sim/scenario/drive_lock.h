// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/loop_electronics.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

inline constexpr double kLockTime = 1.0;               // [s] after power-on
inline constexpr double kAmplitudeErrorLocked = 0.01;  // of the set value
inline constexpr double kPhaseErrorLocked = 0.02;      // [rad]

/// Returns whether the loops hold amplitude and phase with the voltage below
/// its limit.
bool is_locked(const DriveSignals& drive);

/// Returns whether the loops must have locked at `t` [s]: kLockTime after a
/// power-on.
bool lock_is_due(const Scenario& scenario, double t);

/// Returns the times at which the power switches and those at which locking is
/// due.
std::vector<Border> power_borders(const Scenario& scenario);

/// Throws SimulationFailure unless the loops have locked. The message has the
/// time `t` [s], the temperature `beam` [K] and the state of the loops.
void require_locked(const DriveSignals& drive, double t, double beam);

}  // namespace beamgyro
