// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "config/document.h"
#include "sim/campaign/draw_plan.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

/// Returns whether devices may differ in `key` of `document`, whose keys `plan`
/// draws. In a drawn table they differ unless every choice has the value of the
/// file.
bool is_drawn(const DrawPlan& plan, const ConfigDocument& document,
              std::string_view key);

/// Returns the axes that some device may move: those of the scenario itself,
/// those of each choice of `plan` that can be drawn, and those with a number
/// from a continuous distribution. `profiles` are the files that they name.
PerAxis<bool> moved_axes(const ScenarioPlan& scenario,
                         const ConfigDocument& document, const DrawPlan& plan,
                         const ProfileTables& profiles);

}  // namespace beamgyro::internal
