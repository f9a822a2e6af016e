// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "statistics/intervals.h"

namespace beamgyro::internal {

/// A Sobol' index with its interval of 95 %, where there is one.
struct RankIndex {
  double value = 0;
  std::optional<Interval> interval = {};
};

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
/// NaN is a row without a value and does not count. Values that do not vary
/// have the index 0.
///
/// The interval is S -+ t sigma. With the parts
/// p_j = (f_j f_N(j) - S (f_j^2 + f_N(j)^2) / 2) / variance, f less its mean,
/// sigma^2 is their variance with what neighbours have in common,
/// sum p_j (p_j + 2 p_j+1) / rows^2, not less than sum p_j^2 / rows^2 and
/// than (1 - S^2)^2 / rows, that of a correlation of normal numbers (Fisher,
/// 1915). t is Student's, with a degree of freedom for every 8 rows. There is
/// none of fewer than 32 rows, and none with several numbers, of which the bias
/// may be larger than the spread.
RankIndex rank_index(const std::vector<double>& values,
                     const Eigen::MatrixXd& numbers);

}  // namespace beamgyro::internal
