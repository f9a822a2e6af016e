// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "api/unit_gyro.h"
#include "include/beamgyro/device.h"
#include "sim/device/device.h"

namespace beamgyro {

struct Device::State {
  std::string text, name;
  std::vector<std::string> overrides;
  internal::DeviceParameters device;
  internal::UnitGyro gyro = {};
};

}  // namespace beamgyro
