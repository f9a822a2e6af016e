// SPDX-License-Identifier: MIT
#include "sim/scenario/filtered_motion.h"

#include "sim/scenario/square_acceleration.h"

namespace beamgyro::internal {

FilteredMotion::FilteredMotion(const Gyro& gyro, const Motion& motion,
                               double output_rate)
    : mount_(gyro.device.mount) {
  const double corner = gyro.device.readout.corner_frequency;
  const OutputFilter filter(corner);
  for (std::size_t i = 0; i < 3; ++i) {
    rate_[i].filtered = filter.responses(motion.rate()[i], output_rate);
    acceleration_[i].filtered =
        filter.responses(motion.acceleration()[i], output_rate);
  }
  square_.filtered =
      filtered_square_acceleration(motion.acceleration(), corner, output_rate);
}

void FilteredMotion::Filtered::next(std::size_t count) {
  values.resize(count);
  filtered(values);
}

void FilteredMotion::next(std::size_t count) {
  for (std::size_t i = 0; i < 3; ++i) {
    rate_[i].next(count);
    acceleration_[i].next(count);
  }
  square_.next(count);
}

CaseMotion FilteredMotion::at(std::size_t k) const {
  CaseMotion motion;
  motion.x = rate_[0].values[k];
  motion.y = rate_[1].values[k];
  motion.z = rate_[2].values[k];
  motion.in_phase =
      in_phase_rate(mount_,
                    {acceleration_[0].values[k], acceleration_[1].values[k],
                     acceleration_[2].values[k]},
                    square_.values[k]);
  return motion;
}

}  // namespace beamgyro::internal
