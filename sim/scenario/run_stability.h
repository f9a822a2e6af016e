// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "sim/dynamics/rebalance_stability.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Calls stability.check() for all powered and locked samples of a run.
inline void check_stability(const ScenarioPlan& scenario,
                            const RunSamples& samples,
                            RebalanceStability& stability) {
  for (std::size_t k = 0; k < samples.time.size(); ++k)
    if (samples.locked[k] && powered_at(scenario.powered, samples.time[k]))
      stability.check(samples.time[k], samples.temperature[kBeam][k],
                      samples.temperature[kBoard][k]);
}

}  // namespace beamgyro::internal
