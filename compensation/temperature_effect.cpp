// SPDX-License-Identifier: MIT
#include "compensation/temperature_effect.h"

#include <algorithm>

#include "compensation/fit.h"
#include "compensation/row_groups.h"

namespace beamgyro {
namespace {

using Eigen::Index;

constexpr double kSlowNoise = 0.05;   // [-], of n s^2
constexpr double kUnexplained = 0.5;  // [-], of the variance
constexpr double kShareTwice = 0.5;   // [-], of the temperatures

double variance(const TrainingRows& rows) {
  return (rows.bias - rows.bias.mean()).square().mean();
}

}  // namespace

bool temperature_comes_back(const TrainingRows& rows) {
  const auto tenths = groups_in_tenths(rows, rows.leg);
  const auto twice =
      std::count_if(tenths.begin(), tenths.end(),
                    [](const auto& legs) { return legs.size() > 1; });
  return static_cast<double>(twice) >=
         kShareTwice * static_cast<double>(tenths.size());
}

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

bool temperature_shows(const TrainingRows& rows) {
  if (!temperature_comes_back(rows)) return moves_more_than_noise(rows);
  const double left = (rows.bias - fit_baseline(rows).predict(rows.temperature))
                          .square()
                          .mean();
  return left < kUnexplained * variance(rows);
}

}  // namespace beamgyro
