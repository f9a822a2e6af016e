// SPDX-License-Identifier: MIT
#include "sim/scenario/drive_lock.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {

bool lock_is_due(const ScenarioPlan& scenario, double t) {
  const auto after =
      std::upper_bound(scenario.powered.begin(), scenario.powered.end(), t,
                       [](double time, const PowerInterval& powered) {
                         return time < powered.on;
                       });
  if (after == scenario.powered.begin()) return false;
  const PowerInterval& last = *(after - 1);
  return t < last.off && t - last.on >= kLockTime;
}

std::vector<Border> power_borders(const ScenarioPlan& scenario) {
  std::vector<Border> borders;
  for (const PowerInterval& interval : scenario.powered) {
    borders.insert(
        borders.end(),
        {{interval.on, true}, {interval.on + kLockTime}, {interval.off, true}});
  }
  return borders;
}

void require_lock(const ScenarioPlan& scenario, const Recording& block) {
  for (std::size_t k = 0; k < block.time.size(); ++k) {
    const double t = block.time[k];
    if ((block.status[k] & kLoopNotLocked) == 0 || !lock_is_due(scenario, t))
      continue;
    throw SimulationFailure(
        fmt::format("drive loop: not locked at {:g} s, beam at {:.2f} degC, "
                    "drive at {:.4g} "
                    "V; the run stops there, as asked for",
                    t, column_values(block, "true_beam_temperature")[k],
                    column_values(block, "drive_voltage")[k]));
  }
}

}  // namespace beamgyro::internal
