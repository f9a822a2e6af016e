// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace beamgyro::internal {

/// Plain Allan deviation over clusters of `cluster` samples, and 3 sigma of it
/// for white noise, whose successive differences are the most alike (-1/2) of
/// white noise, flicker and random walk: relative sigma 0.87 / sqrt(clusters).
struct AllanDeviation {
  double value;
  double three_sigma;
};

inline AllanDeviation allan_deviation(std::span<const double> rate,
                                      std::size_t cluster) {
  const std::size_t clusters = rate.size() / cluster;
  double sum_of_squares = 0.0, before = 0.0;
  for (std::size_t i = 0; i < clusters; ++i) {
    double mean = 0.0;
    for (double r : rate.subspan(i * cluster, cluster)) mean += r;
    mean /= static_cast<double>(cluster);
    if (i > 0) sum_of_squares += (mean - before) * (mean - before);
    before = mean;
  }
  const double value =
      std::sqrt(0.5 * sum_of_squares / static_cast<double>(clusters - 1));
  return {value, 3.0 * 0.87 / std::sqrt(static_cast<double>(clusters)) * value};
}

}  // namespace beamgyro::internal
