// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "config/document.h"
#include "sim/campaign/draw_plan.h"
#include "sim/scenario/profile_keys.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Whether devices may differ in `key` of `document`, whose keys `plan` draws.
/// Of a drawn table it is asked whether every choice has the value of the file.
bool is_drawn(const DrawPlan& plan, const ConfigDocument& document,
              std::string_view key);

/// The axes, besides the input axis, that a run moves.
struct MovedAxes {
  std::array<bool, 2> cross_rate{};    // about x, y
  std::array<bool, 3> acceleration{};  // along x, y, z
};

/// Those that some device may move: those of the scenario itself, of each
/// choice of `plan` that is ever drawn, and those of which a number is drawn
/// from a continuous distribution. `profiles` are the files they name.
MovedAxes moved_axes(const Scenario& scenario, const ConfigDocument& document,
                     const DrawPlan& plan, const ProfileTables& profiles);

}  // namespace beamgyro
