// SPDX-License-Identifier: MIT
#include "sim/stepper/case_filter.h"

namespace beamgyro::internal {
namespace {

bool rests(const TwoPoles& poles) {
  return poles.first == 0 && poles.second == 0;
}

}  // namespace

CaseFilter::CaseFilter(double corner, const PerAxis<double>& motion)
    : corner_(corner) {
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    axes_[i] = {motion[i], motion[i]};
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    const double a = motion[kAccelerationX + i];
    squares_[i] = {a * a, a * a};
  }
}

void CaseFilter::advance(const PerAxis<double>& from, const PerAxis<double>& to,
                         double duration) {
  const FilterStretch stretch = filter_stretch(corner_, duration);
  for (std::size_t i = 0; i < kCaseAxisCount; ++i) {
    const double rise = to[i] - from[i];
    const bool acts = from[i] != 0 || rise != 0;
    if (acts || !rests(axes_[i])) axes_[i].advance(stretch, from[i], rise);
    if (i < kAccelerationX) continue;
    TwoPoles& square = squares_[i - kAccelerationX];
    if (acts || !rests(square))
      square.advance_square(corner_, from[i], rise / duration, duration);
  }
}

CaseMotion CaseFilter::motion(const MountParameters& mount) const {
  CaseMotion motion;
  motion.x = axes_[kRateX].second;
  motion.y = axes_[kRateY].second;
  motion.z = axes_[kRateZ].second;
  motion.in_phase = in_phase_rate(
      mount,
      {axes_[kAccelerationX].second, axes_[kAccelerationY].second,
       axes_[kAccelerationZ].second},
      squares_[0].second + squares_[1].second + squares_[2].second);
  return motion;
}

bool CaseFilter::is_rate_z_alone() const {
  for (std::size_t i = kRateX; i < kCaseAxisCount; ++i)
    if (!rests(axes_[i])) return false;
  for (const TwoPoles& square : squares_)
    if (!rests(square)) return false;
  return true;
}

void CaseFilter::archive(StateArchive& archive) {
  for (TwoPoles& poles : axes_) archive(poles.first, poles.second);
  for (TwoPoles& poles : squares_) archive(poles.first, poles.second);
}

}  // namespace beamgyro::internal
