// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "sim/dynamics/envelope.h"

namespace beamgyro::internal {

/// Watches over the loop of a force-rebalance unit, whose gains are set at T_0:
/// a sense mode of high Q that moves away from there makes it oscillate. The
/// loop is linearised (loop_noise()) at the first sample and wherever the beam
/// or the board has changed by kNoiseRefresh. Memory is left out.
class RebalanceStability {
 public:
  /// `gyro` must outlive the object.
  explicit RebalanceStability(const TrimmedGyro& gyro)
      : gyro_(gyro), ode_(gyro, drive_heating(gyro)) {}

  /// Throws SimulationFailure when the loop is unstable with the beam and the
  /// board at these temperatures [K], which a powered and locked unit has at
  /// `t` [s]. The message names time, temperature and keys.
  void check(double t, double beam, double board);

 private:
  const TrimmedGyro& gyro_;
  EnvelopeOde ode_;
  double beam_ = 0, board_ = 0;  // checked last [K]
};

/// None for a unit in open loop.
std::optional<RebalanceStability> rebalance_stability(const TrimmedGyro& gyro);

}  // namespace beamgyro::internal
