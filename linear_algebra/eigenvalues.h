// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

// Both functions may be called from several threads. Elements that are not
// finite give a result without a meaning.
namespace beamgyro::internal {

/// A = V diag(values) V^T of a symmetric A, n x n.
struct SymmetricEigen {
  Eigen::VectorXd values;   // increasing
  Eigen::MatrixXd vectors;  // V: a column each, orthonormal
};

/// Decomposes a symmetric A, of which the lower triangle is read. A singular A
/// has values of 0 but for rounding, of either sign.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Returns the n complex lambda with det(A - lambda I) = 0 of any square A, in
/// no order.
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& A);

}  // namespace beamgyro::internal
