// SPDX-License-Identifier: MIT
#pragma once

#include "sim/scenario/scenario.h"

namespace beamgyro {

/// The scenario with one time for what happens at one time (is_same_time()).
/// Switches of the power, jumps and bends of profiles that rounding keeps from
/// coinciding move to the sample that is there, else to the number of nine
/// decimals that is there, else to the last of them. So do switches and jumps
/// that are alone; bends that are alone stay. Two points of one profile at one
/// time make a jump. Random motions are not drawn yet: their points stay.
Scenario with_aligned_borders(const Scenario& scenario);

}  // namespace beamgyro
