// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "sim/dynamics/gyro.h"
#include "sim/memory/memory_trajectory.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Returns what heats and cools a gyro in a scenario (4.1): the ambient, and
/// electronics and drive while powered.
ThermalLoad thermal_load(const ScenarioPlan& scenario, const TrimmedGyro& gyro);

/// The node temperatures over the whole run, with straight lines between the
/// points of a grid. Throws as MaterialLimits.
class RunTemperatures {
 public:
  RunTemperatures(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                  double step);

  double at(ThermalNode node, double t) const;  // [K]

 private:
  double step_;  // [s]
  ThermalHistory history_;
};

/// Returns the memory of a unit at the start of a scenario, to be driven by its
/// thermal solution, or null for a unit without memory effects.
std::unique_ptr<MemoryTrajectory> memory_at_start(const ScenarioPlan& scenario,
                                                  const TrimmedGyro& gyro);

/// The same, driven over the whole scenario.
std::unique_ptr<MemoryTrajectory> memory_of_run(const ScenarioPlan& scenario,
                                                const TrimmedGyro& gyro);

}  // namespace beamgyro::internal
