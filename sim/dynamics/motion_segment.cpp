// SPDX-License-Identifier: MIT
#include "sim/dynamics/motion_segment.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace beamgyro::internal {
namespace {

double value(const AxisSegment& s, double since, double t) {
  double v = s.a + s.b * since;
  if (s.amplitude != 0) v += s.amplitude * std::sin(s.omega * t + s.phase);
  return v;
}

double slope(const AxisSegment& s, double t) {
  if (s.amplitude == 0) return s.b;
  return s.b + s.amplitude * s.omega * std::cos(s.omega * t + s.phase);
}

bool moving(const AxisSegment& s) { return s.b != 0 || s.amplitude != 0; }

bool is_zero(const AxisSegment& s) { return s.a == 0 && !moving(s); }

}  // namespace

MotionSegment::MotionSegment(double start, const PerAxis<AxisSegment>& axes,
                             const MountParameters& mount)
    : start_(start),
      axes_(axes),
      accelerated_(
          !std::all_of(axes.begin() + kAccelerationX, axes.end(), is_zero)),
      mount_(mount) {}

CaseMotion MotionSegment::at(double t) const {
  CaseMotion motion = at_rest(t);
  motion.z = value(axes_[kRateZ], t - start_, t);
  motion.z_acceleration = slope(axes_[kRateZ], t);
  return motion;
}

CaseMotion MotionSegment::at_rest(double t) const {
  CaseMotion motion;
  motion.x = value(axes_[kRateX], t - start_, t);
  motion.y = value(axes_[kRateY], t - start_, t);
  if (accelerated_) {
    std::array<double, 3> a{};
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] = value(axes_[kAccelerationX + i], t - start_, t);
    motion.in_phase = in_phase_rate(mount_, a);
  }
  return motion;
}

bool MotionSegment::is_constant() const {
  return std::none_of(axes_.begin(), axes_.end(), moving);
}

}  // namespace beamgyro::internal
