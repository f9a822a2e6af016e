// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "include/beamgyro/scenario.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/simulation_input.h"
#include "sim/stepper/stepper_model.h"

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

/// What the steppers of a device share, made when it is first asked for.
class UnitModel {
 public:
  /// Throws as make_gyro(). Any thread may call it.
  const std::shared_ptr<const StepperModel>& of(const TrimmedGyro& gyro) const {
    std::call_once(once_, [&] { model_ = stepper_model(gyro); });
    return model_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::shared_ptr<const StepperModel> model_;
};

struct DeviceState {
  std::string text, name;
  std::vector<std::string> overrides;
  DeviceParameters device;
  UnitGyro gyro = {};
  UnitModel model = {};
};

/// The solved beam and trims of a device. Throws as make_gyro().
inline const TrimmedGyro& gyro_of(const Device& device) {
  return device.content().gyro.of(device.content().device);
}

/// What the steppers of a device share. Throws as make_gyro().
inline const std::shared_ptr<const StepperModel>& stepper_model_of(
    const Device& device) {
  return device.content().model.of(gyro_of(device));
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
