// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "api/device_state.h"
#include "include/beamgyro/scenario.h"
#include "sim/scenario/simulation_input.h"

namespace beamgyro {

struct Scenario::State {
  internal::InputText scenario, device;
  std::vector<std::string> device_overrides, overrides;
  internal::LoadedScenario loaded;  // with all of them applied
  internal::UnitGyro gyro = {};
};

}  // namespace beamgyro
