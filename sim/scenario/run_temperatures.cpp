// SPDX-License-Identifier: MIT
#include "sim/scenario/run_temperatures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/scenario/material_limits.h"

namespace beamgyro::internal {

ThermalLoad thermal_load(const ScenarioPlan& scenario, const Gyro& gyro) {
  const DriveHeating heating = drive_heating(gyro);
  return {.ambient = scenario.ambient,
          .stirred = scenario.stirred,
          .powered = scenario.powered,
          .mechanical_power = heating.mechanical,
          .dielectric_power = heating.dielectric};
}

RunTemperatures::RunTemperatures(const ScenarioPlan& scenario, const Gyro& gyro,
                                 double step)
    : step_(step) {
  std::vector<double> times;
  for (std::size_t k = 0;; ++k) {
    times.push_back(static_cast<double>(k) * step);
    if (times.back() >= scenario.duration) break;
  }
  history_ = simulate_temperatures(ThermalNetwork(gyro.device.thermal),
                                   thermal_load(scenario, gyro), times);
  MaterialLimits(scenario, gyro.device.thermal)
      .check(times, history_.temperature);
}

double RunTemperatures::at(ThermalNode node, double t) const {
  const std::vector<double>& values = history_.temperature[node];
  const double place = t / step_;
  const auto left = std::min(static_cast<std::size_t>(place),
                             std::max<std::size_t>(values.size(), 2) - 2);
  return std::lerp(values[left], values[left + 1],
                   place - static_cast<double>(left));
}

}  // namespace beamgyro::internal
