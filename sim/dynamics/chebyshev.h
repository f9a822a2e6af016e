// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace beamgyro::internal {

/// Chebyshev node i of n on [-1, 1].
inline double chebyshev_node(int i, int n) {
  return std::cos(std::numbers::pi * (i + 0.5) / n);
}

/// Writes T_0(x) .. T_{n-1}(x), a column each, one row for each x.
template <class Column, class Basis>
void chebyshev_basis(const Column& x, Basis& basis) {
  basis.col(0).setOnes();
  if (basis.cols() > 1) basis.col(1) = x;
  for (Eigen::Index k = 2; k < basis.cols(); ++k)
    basis.col(k) = 2 * x * basis.col(k - 1) - basis.col(k - 2);
}

/// Returns the matrix that turns values at n Chebyshev nodes into n
/// coefficients.
inline Eigen::MatrixXd chebyshev_transform(int n) {
  Eigen::MatrixXd transform(n, n);
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      transform(k, i) = (k == 0 ? 1.0 : 2.0) / n *
                        std::cos(std::numbers::pi * k * (i + 0.5) / n);
    }
  }
  return transform;
}

}  // namespace beamgyro::internal
