// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sensitivity/indices/index_interval.h"

namespace beamgyro::internal {

/// Estimates the first-order Sobol' index of one factor from a single sample,
/// without a value at any further point:
///
///   S = (mean f_j f_N(j) - mean^2) / variance
///
/// `numbers` has the factor's numbers in [0, 1], one row for each value and one
/// column for each number. With one number N(j) is the row whose number comes
/// next, and the first after the last (Gamboa, Gremaud, Klein and Lagnoux,
/// Bernoulli 28 (2022) 2345, after Chatterjee's correlation). With several,
/// which have no order, it is the nearest other row, among the first 8192; the
/// bias then falls as slowly as the distance to it, that is as
/// rows^(-1/numbers) where f is smooth.
///
/// NaN is a row without a value and does not count. The interval is that of
/// blocks of 16 successive products drawn again with replacement (random stream
/// kRankResampleStream of `seed`, run `stream`). Values that do not vary have
/// the index 0.
IndexEstimate rank_index(const std::vector<double>& values,
                         const Eigen::MatrixXd& numbers, std::uint64_t seed,
                         std::uint32_t stream);

}  // namespace beamgyro::internal
