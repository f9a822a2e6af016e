// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "sim/dynamics/gyro.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Node temperatures of a scenario at increasing times [s] (4.1), with the heat
/// of electronics and drive while powered.
ThermalHistory run_temperatures(const Scenario& scenario, const Gyro& gyro,
                                std::span<const double> times);

/// The same over the whole run, linear between points of a grid.
class RunTemperatures {
 public:
  RunTemperatures(const Scenario& scenario, const Gyro& gyro, double step);

  double at(ThermalNode node, double t) const;  // [K]

 private:
  double step_;  // [s]
  ThermalHistory history_;
};

}  // namespace beamgyro
