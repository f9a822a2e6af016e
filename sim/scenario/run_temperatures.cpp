// SPDX-License-Identifier: MIT
#include "sim/scenario/run_temperatures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/scenario/material_limits.h"

namespace beamgyro::internal {

ThermalLoad thermal_load(const ScenarioPlan& scenario,
                         const TrimmedGyro& gyro) {
  const DriveHeating heating = drive_heating(gyro);
  return {.ambient = scenario.ambient,
          .stirred = scenario.stirred,
          .powered = scenario.powered,
          .mechanical_power = heating.mechanical,
          .dielectric_power = heating.dielectric};
}

RunTemperatures::RunTemperatures(const ScenarioPlan& scenario,
                                 const TrimmedGyro& gyro, double step)
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

std::unique_ptr<MemoryTrajectory> memory_at_start(const ScenarioPlan& scenario,
                                                  const TrimmedGyro& gyro) {
  const DeviceParameters& device = gyro.device;
  if (!device.memory.any()) return nullptr;
  return std::make_unique<MemoryTrajectory>(
      UnitMemory(device.memory, device.bond.glass_transition,
                 {scenario.history, scenario.age}, scenario.ambient.value(0)));
}

std::unique_ptr<MemoryTrajectory> memory_of_run(const ScenarioPlan& scenario,
                                                const TrimmedGyro& gyro) {
  std::unique_ptr<MemoryTrajectory> memory = memory_at_start(scenario, gyro);
  if (!memory) return nullptr;
  integrate_temperatures(ThermalNetwork(gyro.device.thermal),
                         thermal_load(scenario, gyro), scenario.duration,
                         memory->sink());
  memory->finish();
  return memory;
}

}  // namespace beamgyro::internal
