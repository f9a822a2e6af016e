// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace beamgyro {

/// Numbers of one draw that depend on each other as normal ones of a given
/// correlation do: z = L z', correlation = L L^T, each z a normal quantile.
struct CorrelatedGroup {
  std::vector<std::size_t> members;  // indices of the numbers
  Eigen::MatrixXd factor;            // L, lower
};

/// Lower factor L of a correlation matrix. Throws std::invalid_argument when it
/// is not symmetric with ones on its diagonal and positive definite.
Eigen::MatrixXd correlation_factor(const Eigen::MatrixXd& correlation);

/// Makes the independent uniform numbers of the group's members dependent;
/// each stays uniform.
void correlate(const CorrelatedGroup& group, std::span<double> numbers);

}  // namespace beamgyro
