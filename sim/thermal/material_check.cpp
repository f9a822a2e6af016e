// SPDX-License-Identifier: MIT
#include "sim/thermal/material_check.h"

#include <fmt/format.h>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

bool materials_stand(double temperature) {
  constexpr double kRoundoff = 1e-3;  // of the integration [K]
  const double T = temperature - kZeroCelsius;
  return T >= kMaterialTemperatures.low - kRoundoff &&
         T <= kMaterialTemperatures.high + kRoundoff;
}

void check_materials(double t, const NodeVector& nodes, double ambient,
                     double electronics_power) {
  for (Eigen::Index node = 0; node < nodes.size(); ++node) {
    if (materials_stand(nodes(node))) continue;
    throw SimulationFailure(fmt::format(
        "{} at {:.4g} degC at {:.6g} s, beyond {:g} to {:g} degC, {}; ambient "
        "is {:.4g} degC and thermal.electronics_power_W = {:g}",
        kThermalNodeNames[static_cast<std::size_t>(node)],
        nodes(node) - kZeroCelsius, t, kMaterialTemperatures.low,
        kMaterialTemperatures.high, kMaterialReason, ambient - kZeroCelsius,
        electronics_power));
  }
}

}  // namespace beamgyro::internal
