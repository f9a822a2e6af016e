// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/scenario/scenario.h"
#include "sim/thermal/material_check.h"
#include "sim/thermal/thermal_trajectory.h"

namespace beamgyro::internal {

/// Refuses the runs of one gyro in one scenario whose heat the materials do not
/// stand: SimulationFailure says which part leaves kMaterialTemperatures when,
/// and what heats it. It is the same in every fidelity.
class MaterialLimits {
 public:
  /// `scenario` must outlive the object.
  MaterialLimits(const ScenarioPlan& scenario, const ThermalParameters& thermal)
      : scenario_(scenario), electronics_power_(thermal.electronics_power) {}

  /// `nodes` [K] at `t` [s], by ThermalNode.
  void check(double t, const NodeVector& nodes) const;

  /// The temperatures at many times, by ThermalNode.
  void check(
      std::span<const double> times,
      const std::array<std::vector<double>, kThermalNodeCount>& nodes) const;

  /// Returns whether the materials stand every temperature of `range`.
  static bool stand(const TemperatureSpan& range);

  /// Every sample of a run.
  void check(const ThermalTrajectory& temperatures,
             const SampleGrid& grid) const;

 private:
  const ScenarioPlan& scenario_;
  double electronics_power_;  // [W]
};

}  // namespace beamgyro::internal
