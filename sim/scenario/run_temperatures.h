// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Returns what heats and cools a gyro in a scenario (4.1): the ambient, and
/// electronics and drive while powered.
ThermalLoad thermal_load(const ScenarioPlan& scenario, const Gyro& gyro);

/// The node temperatures over the whole run, with straight lines between the
/// points of a grid. Throws as MaterialLimits.
class RunTemperatures {
 public:
  RunTemperatures(const ScenarioPlan& scenario, const Gyro& gyro, double step);

  double at(ThermalNode node, double t) const;  // [K]

 private:
  double step_;  // [s]
  ThermalHistory history_;
};

}  // namespace beamgyro::internal
