// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/campaign/draw_plan.h"

namespace beamgyro::internal {

/// Numbers of a device that are drawn together and independently of all others:
/// all elements of a key, and all keys that a correlation joins.
struct Factor {
  std::string key;                   // dotted keys, " + " between several
  std::vector<std::size_t> numbers;  // indices of DrawPlan::parameters
};

/// Returns the factors of a plan, in the order of their first keys.
std::vector<Factor> factors_of(const DrawPlan& plan);

/// Throws std::invalid_argument "CAMPAIGN: ..." for fewer than two factors.
void require_comparable(const std::vector<Factor>& factors,
                        const std::string& campaign);

/// Returns the plan with draw `index` of half its width (halved()).
DrawPlan with_halved(DrawPlan plan, std::size_t index);

}  // namespace beamgyro::internal
