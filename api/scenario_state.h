// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "include/beamgyro/scenario.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/simulation_input.h"

namespace beamgyro::internal {

/// The solved beam and trims of a device, made when they are first asked for.
class UnitGyro {
 public:
  /// Throws as make_gyro(). Any thread may call it.
  const TrimmedGyro& of(const DeviceParameters& device) const {
    std::call_once(once_, [&] { gyro_.emplace(make_gyro(device)); });
    return *gyro_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<TrimmedGyro> gyro_;
};

struct DeviceState {
  std::string text, name;
  std::vector<std::string> overrides;
  DeviceParameters device;
  UnitGyro gyro = {};
};

/// The solved beam and trims of a device. Throws as make_gyro().
inline const TrimmedGyro& gyro_of(const Device& device) {
  return device.content().gyro.of(device.content().device);
}

struct ScenarioState {
  InputText scenario, device;
  std::vector<std::string> device_overrides, overrides;
  LoadedScenario loaded;  // with all of them applied
  UnitGyro gyro = {};
};

/// Throws OptionError for the key "device": it is a text in memory, and no key
/// can name another one.
void require_no_device_key(const std::vector<std::string>& overrides);

}  // namespace beamgyro::internal
