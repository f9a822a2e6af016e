// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/dynamics/gyro.h"
#include "sim/numerics/state_archive.h"
#include "sim/signal/two_poles.h"
#include "sim/stepper/step_inputs.h"

namespace beamgyro::internal {

/// The motion of the case behind the output filter, for a static response to
/// it: two equal poles for each axis and for the square of each acceleration,
/// moved on exactly from step to step.
class CaseFilter {
 public:
  /// Starts settled on `motion` [rad/s] [m/s2]. `corner` is that of each pole
  /// [rad/s].
  CaseFilter(double corner, const PerAxis<double>& motion);

  /// Advances by `duration` [s] while each axis goes from `from` to `to` along
  /// a straight line.
  void advance(const PerAxis<double>& from, const PerAxis<double>& to,
               double duration);

  CaseMotion motion(const MountParameters& mount) const;
  double rate_z() const { return axes_[kRateZ].second; }  // [rad/s]
  /// Returns whether nothing but the rate about z acts.
  bool is_rate_z_alone() const;

  void archive(StateArchive& archive);

 private:
  double corner_;  // [rad/s]
  PerAxis<TwoPoles> axes_;
  std::array<TwoPoles, 3> squares_;
};

}  // namespace beamgyro::internal
