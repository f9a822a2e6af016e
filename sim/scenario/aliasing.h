// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Returns one warning for each motion that the samples do not show:
/// - a sine of half the output rate or more;
/// - a random motion whose bandwidth is half the output rate or more;
/// - a profile with swings of which the samples show less than half. A swing
///   goes from one turn of the profile to the next; one of less than 5 % of the
///   range of the profile counts as noise.
std::vector<std::string> aliasing_warnings(const ScenarioPlan& scenario);

}  // namespace beamgyro::internal
