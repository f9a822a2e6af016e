// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// What the output filter, two equal poles `corner` [rad/s], shows of |a|^2
/// [m2/s4] at every sample of a scenario: of a vibration the mean square,
/// however fast it is, for the mechanics rectify it in front of the filter.
/// Exact for every form of profile; at t = 0 the filter has settled on the
/// value there, on a sine it has settled for ever.
std::vector<double> filtered_square_acceleration(const Scenario& scenario,
                                                 double corner,
                                                 const RunKey& key);

}  // namespace beamgyro
