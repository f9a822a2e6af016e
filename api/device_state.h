// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "include/beamgyro/device.h"
#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// The solved beam and trims of a device, made when they are first asked for.
class UnitGyro {
 public:
  /// Throws as make_gyro(). Any thread may call it.
  const Gyro& of(const DeviceParameters& device) const {
    std::call_once(once_, [&] { gyro_.emplace(make_gyro(device)); });
    return *gyro_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<Gyro> gyro_;
};

}  // namespace beamgyro::internal

namespace beamgyro {

struct Device::State {
  std::string text, name;
  std::vector<std::string> overrides;
  internal::DeviceParameters device;
  internal::UnitGyro gyro = {};
};

}  // namespace beamgyro
