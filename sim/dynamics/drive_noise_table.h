// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// The white noise of drive frequency [Hz] and voltage [V] in a sample: the
/// density of drive_noise() over the temperature of the beam, with straight
/// lines between points 4 K apart at most. The board is as warm as the beam:
/// what it turns is the readout, behind the drive loop.
class DriveNoiseTable {
 public:
  /// Tabulates beam temperatures from `coldest` to `hottest` [K], for samples
  /// at `rate` [Hz]. Throws as loop_noise().
  DriveNoiseTable(const TrimmedGyro& gyro, double coldest, double hottest,
                  double rate);

  /// Returns sigma (frequency, voltage) of a sample with the beam at `beam`
  /// [K]; beyond an end of the table that of the end.
  Eigen::Vector2d at(double beam) const;

  /// Returns the same at T_0, where the table need not reach.
  const Eigen::Vector2d& at_trim() const { return at_trim_; }

 private:
  double coldest_, step_;  // [K]
  std::vector<Eigen::Vector2d> sigma_;
  Eigen::Vector2d at_trim_;
};

}  // namespace beamgyro::internal
