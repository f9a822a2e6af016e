// SPDX-License-Identifier: MIT
#include "compensation/scoring/residual_scores.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamgyro::internal {

std::vector<double> block_residuals(std::span<const SampleRange> blocks,
                                    std::span<const double> rate,
                                    std::span<const double> true_rate) {
  assert(rate.size() == true_rate.size());
  std::vector<double> means;
  means.reserve(blocks.size());
  for (const SampleRange& block : blocks) {
    double sum = 0.0;
    for (std::size_t k = block.begin; k < block.end; ++k)
      sum += rate[k] - true_rate[k];
    means.push_back(sum / static_cast<double>(block.size()));
  }
  return means;
}

ResidualScores residual_scores(std::span<const double> residuals) {
  if (residuals.empty())
    throw std::invalid_argument("residual: no block to score");
  const auto n = static_cast<double>(residuals.size());
  double sum = 0.0;
  double squares = 0.0;
  double least = residuals.front();
  double most = least;
  for (const double r : residuals) {
    sum += r;
    squares += r * r;
    least = std::min(least, r);
    most = std::max(most, r);
  }
  if (!std::isfinite(squares)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {residuals.size(), nan, nan, nan, nan, nan, nan};
  }
  const double mean = sum / n;
  double about_mean = 0.0;
  for (const double r : residuals) about_mean += (r - mean) * (r - mean);
  return {.blocks = residuals.size(),
          .mean = mean,
          .variance = about_mean / n,
          .sigma = std::sqrt(about_mean / n),
          .rms = std::sqrt(squares / n),
          .peak_to_peak = most - least,
          .largest = std::max(std::abs(least), std::abs(most))};
}

}  // namespace beamgyro::internal
