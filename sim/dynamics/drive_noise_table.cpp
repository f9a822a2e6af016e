// SPDX-License-Identifier: MIT
#include "sim/dynamics/drive_noise_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/dynamics/loop_noise.h"

namespace beamgyro::internal {

DriveNoiseTable::DriveNoiseTable(const TrimmedGyro& gyro, double coldest,
                                 double hottest, double rate)
    : coldest_(coldest) {
  constexpr double kWidest = 4;  // [K]
  EnvelopeOde ode(gyro, drive_heating(gyro));
  const auto sigma = [&](double T) -> Eigen::Vector2d {
    return std::sqrt(rate) *
           drive_noise(ode.loops(), loop_noise(gyro, ode, T, T));
  };
  const auto intervals =
      static_cast<int>(std::ceil((hottest - coldest) / kWidest));
  step_ = intervals > 0 ? (hottest - coldest) / intervals : kWidest;
  for (int i = 0; i <= intervals; ++i)
    sigma_.push_back(sigma(std::min(coldest_ + i * step_, hottest)));
  at_trim_ = sigma(kCalibrationTemperature);
}

Eigen::Vector2d DriveNoiseTable::at(double beam) const {
  const double last = static_cast<double>(sigma_.size() - 1);
  const double place = std::clamp((beam - coldest_) / step_, 0.0, last);
  const auto left = static_cast<std::size_t>(place);
  const std::size_t right = std::min(left + 1, sigma_.size() - 1);
  return sigma_[left] +
         (place - static_cast<double>(left)) * (sigma_[right] - sigma_[left]);
}

}  // namespace beamgyro::internal
