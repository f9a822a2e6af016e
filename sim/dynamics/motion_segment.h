// SPDX-License-Identifier: MIT
#pragma once

#include "sim/device/case_axis.h"
#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// a + b (t - start) + amplitude sin(omega t + phase)
struct AxisSegment {
  double a = 0, b = 0;
  double amplitude = 0, omega = 0, phase = 0;
};

/// The motion of the case between two borders, smooth up to both ends.
class MotionSegment {
 public:
  MotionSegment(double start, const PerAxis<AxisSegment>& axes,
                const MountParameters& mount);

  CaseMotion at(double t) const;
  /// Returns the motion of the twin: the same, with the rate about z and its
  /// derivative set to 0.
  CaseMotion at_rest(double t) const;

  bool is_constant() const;  // at() does not depend on t

 private:
  double start_;
  PerAxis<AxisSegment> axes_;  // [rad/s] [m/s2]
  bool accelerated_;
  MountParameters mount_;
};

}  // namespace beamgyro::internal
