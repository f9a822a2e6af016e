// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {

/// Scores of n block means r_i of a residual rate. The run was not trained on,
/// so the variance divides by n.
struct ResidualScores {
  std::size_t blocks = 0;     // n
  double mean = 0.0;          // [deg/s], of the r_i
  double variance = 0.0;      // [(deg/s)^2], Σ (r_i - mean)^2 / n
  double sigma = 0.0;         // [deg/s], sqrt(variance)
  double rms = 0.0;           // [deg/s], sqrt(Σ r_i^2 / n), about zero
  double peak_to_peak = 0.0;  // [deg/s], max r_i - min r_i
  double largest = 0.0;       // [deg/s], max |r_i|
};

/// Returns the mean of rate - true_rate [deg/s] over each block. A value that
/// is not finite makes the mean of its block not finite.
std::vector<double> block_residuals(std::span<const SampleRange> blocks,
                                    std::span<const double> rate,
                                    std::span<const double> true_rate);

/// Returns the scores. All are NaN when a block is not finite, so that a
/// missing answer is never scored as a good one. Throws std::invalid_argument
/// when there is no block.
ResidualScores residual_scores(std::span<const double> block_residuals);

}  // namespace beamgyro::internal
