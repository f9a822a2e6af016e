// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/modal_table.h"
#include "sim/memory/memory_trajectory.h"

namespace beamgyro::internal {

/// What the memory of one unit adds to the coefficients of its ModalTable over
/// a run. At each knot of the trajectory it is the difference of the exact
/// parameters with and without memory, and it is cubic in time between knots.
/// It is linear in the hysteresis between 0 and the extreme of its sign: what
/// is left out is worth less than 1e-5 deg/s for a turn of the mount's axis of
/// 0.02 deg.
class ModalMemory {
 public:
  /// The trajectory must outlive the object.
  ModalMemory(const Gyro& gyro, const MemoryTrajectory& memory);

  /// The coefficients to add at time `t` [s] with the beam at `beam` [K].
  /// `interval` is where the last call found its knots, and 0 at first.
  ModalChannels at(double t, double beam, std::size_t& interval) const;

 private:
  const MemoryTrajectory& memory_;
  SmoothCourse<ModalChannels> without_hysteresis_, per_hysteresis_;
};

}  // namespace beamgyro::internal
