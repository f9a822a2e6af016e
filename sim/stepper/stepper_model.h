// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "sim/dynamics/drive_noise_table.h"
#include "sim/dynamics/gyro.h"
#include "sim/dynamics/static_map.h"

namespace beamgyro::internal {

/// What the steppers of one device share. It does not change, and many threads
/// may use it at once.
struct StepperModel {
  TrimmedGyro gyro;
  /// The static response to the temperature of the beam and the rate about z,
  /// within these limits; none for a unit whose response depends on more.
  std::optional<StaticMap> map;
  double coldest = 0, hottest = 0;  // [K]
  double fastest = 0;               // [rad/s]
  /// At ticks of 1 Hz; none for a unit whose loop channels carry no noise.
  std::optional<DriveNoiseTable> drive_noise;
};

std::shared_ptr<const StepperModel> stepper_model(TrimmedGyro gyro);

}  // namespace beamgyro::internal
