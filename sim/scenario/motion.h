// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/dynamics/gyro.h"
#include "sim/dynamics/motion_segment.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// The motion of the case over a whole run. Random rates have been drawn.
class Motion {
 public:
  Motion(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
         const RunKey& key);

  /// Returns the times at which an axis bends or jumps, axis by axis.
  std::vector<Border> borders() const;
  /// Returns whether the rate about z is zero all the time, so that the twin is
  /// the run itself.
  bool rate_is_zero() const { return !moves_[kRateZ]; }
  /// Returns whether anything but the rate about z moves.
  bool has_other_axes() const;

  const PerAxis<Signal>& axes() const { return axes_; }  // [rad/s] [m/s2]

  /// Returns the motion between two times that have no border between them,
  /// from the right-hand limits at `start` to the left-hand limits at `end`.
  MotionSegment segment(double start, double end) const;

  /// Writes the motion at the times of `samples` to `samples`.
  void sample(RunSamples& samples) const;

 private:
  PerAxis<Signal> axes_;
  PerAxis<bool> moves_{};
  MountParameters mount_;
};

}  // namespace beamgyro::internal
