// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace beamgyro::internal {

/// Numbers of one draw that are correlated by a Gaussian copula: z = L z',
/// correlation = L L^T, where each z is the normal quantile of a number.
struct CorrelatedGroup {
  std::vector<std::size_t> members;  // indices of the numbers
  Eigen::MatrixXd factor;            // L, lower
};

/// Returns the lower factor L of a correlation matrix. Throws
/// std::invalid_argument when it is not symmetric with ones on its diagonal and
/// positive definite.
Eigen::MatrixXd correlation_factor(const Eigen::MatrixXd& correlation);

/// Correlates the independent uniform numbers of the members of the group. Each
/// stays uniform.
void correlate(const CorrelatedGroup& group, std::span<double> numbers);

}  // namespace beamgyro::internal
