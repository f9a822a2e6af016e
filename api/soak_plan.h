// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "include/beamgyro/plan.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument unless there is one goal.
void check_goal(const PlanOptions& options);

/// Soaks of the user's own [degC], and where they are given, for messages.
struct NamedSoaks {
  std::string where;
  std::vector<double> soaks;
};

/// Plans, and judges `candidates` in place of those of the options. Throws as
/// plan(), and std::invalid_argument "where: ..." for soaks beyond the chamber
/// and for two that are closer together than kPointWidth.
SoakPlanResult planned(const Compensator& population, const Device& device,
                       const PlanOptions& options,
                       const std::vector<NamedSoaks>& candidates);

}  // namespace beamgyro::internal
