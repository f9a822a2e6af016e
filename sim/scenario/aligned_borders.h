// SPDX-License-Identifier: MIT
#pragma once

#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Returns the scenario with times that only rounding keeps apart
/// (is_same_time()) made equal. Power switches, jumps and bends of profiles at
/// the same time move together:
/// - to the sample at that time, if there is one;
/// - else to the number of nine decimals at that time;
/// - else to the last of them.
/// A single switch or jump moves likewise; a single bend stays. Two points of
/// one profile at the same time make a jump. Random motions have no points yet
/// and are not changed.
ScenarioPlan with_aligned_borders(const ScenarioPlan& scenario);

}  // namespace beamgyro::internal
