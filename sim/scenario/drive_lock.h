// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/recording/recording.h"
#include "sim/dynamics/loop_electronics.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

inline constexpr double kLockTime = 1.0;  // [s] after power-on

/// Returns whether the loops of a sound device are locked at `t` [s]: the power
/// has been on for kLockTime.
bool lock_is_due(const ScenarioPlan& scenario, double t);

/// Returns the times at which the power switches and, without a jump, those at
/// which locking is due. There the steps of a start-up end.
std::vector<Border> power_borders(const ScenarioPlan& scenario);

/// Throws SimulationFailure at the first sample of a block that is not locked
/// although that is due. The message has its time, temperature and voltage.
void require_lock(const ScenarioPlan& scenario, const Recording& block);

}  // namespace beamgyro::internal
