// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

namespace beamgyro::internal {

/// A symmetric matrix with half bandwidth 3.
struct SymmetricBand {
  static constexpr Eigen::Index kHalf = 3;

  explicit SymmetricBand(Eigen::Index size)
      : diagonals(Eigen::Matrix<double, Eigen::Dynamic, kHalf + 1>::Zero(
            size, kHalf + 1)) {}

  Eigen::Index size() const { return diagonals.rows(); }
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
  Eigen::MatrixXd dense() const;

  // diagonals(j, d) = A(j + d, j) = A(j, j + d); unused past the end.
  Eigen::Matrix<double, Eigen::Dynamic, kHalf + 1> diagonals;
};

/// Solves A x = b by Gaussian elimination with partial pivoting. A need not be
/// definite. Returns nothing when a pivot is 0.
std::optional<Eigen::VectorXd> solved(const SymmetricBand& A,
                                      Eigen::VectorXd b);

}  // namespace beamgyro::internal
