// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace beamgyro::internal {

/// A Sobol' index with its interval of 95 %.
struct IndexEstimate {
  double value = 0, low = 0, high = 0;  // [-]
};

/// How often an estimate is made again from resampled values for its interval.
inline constexpr std::size_t kResamples = 400;

/// Returns `value` with the interval of 95 % of its replicates: their 2.5 and
/// 97.5 percentiles (Efron, 1979). Replicates that are not finite do not count;
/// without any the interval is `value`.
IndexEstimate with_interval(double value, std::vector<double> replicates);

}  // namespace beamgyro::internal
