// SPDX-License-Identifier: MIT
#include "compensation/training/temperature_effect.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;

constexpr double kSlowNoise = 0.05;  // [-], of n s^2

double variance(const TrainingRows& rows) {
  return (rows.bias - rows.bias.mean()).square().mean();
}

}  // namespace

bool moves_more_than_noise(const TrainingRows& rows) {
  double squares = 0.0, count = 0.0;
  for (Index k = 2; k < rows.size(); ++k) {
    if (rows.cycle(k) != rows.cycle(k - 2)) continue;
    const double second =
        rows.bias(k) - 2.0 * rows.bias(k - 1) + rows.bias(k - 2);
    squares += second * second;
    count += 1.0;
  }
  return count > 0.0 && variance(rows) > kSlowNoise *
                                             static_cast<double>(rows.size()) *
                                             0.5 * squares / count;
}

}  // namespace beamgyro::internal
