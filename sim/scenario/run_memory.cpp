// SPDX-License-Identifier: MIT
#include "sim/scenario/run_memory.h"

#include "sim/scenario/run_temperatures.h"

namespace beamgyro::internal {

std::unique_ptr<MemoryTrajectory> memory_at_start(const ScenarioPlan& scenario,
                                                  const Gyro& gyro) {
  const DeviceParameters& device = gyro.device;
  if (!device.memory.any()) return nullptr;
  return std::make_unique<MemoryTrajectory>(
      UnitMemory(device.memory, device.bond.glass_transition,
                 {scenario.history, scenario.age}, scenario.ambient.value(0)));
}

std::unique_ptr<MemoryTrajectory> memory_of_run(const ScenarioPlan& scenario,
                                                const Gyro& gyro) {
  std::unique_ptr<MemoryTrajectory> memory = memory_at_start(scenario, gyro);
  if (!memory) return nullptr;
  integrate_temperatures(ThermalNetwork(gyro.device.thermal),
                         thermal_load(scenario, gyro), scenario.duration, {},
                         memory->sink());
  memory->finish();
  return memory;
}

}  // namespace beamgyro::internal
