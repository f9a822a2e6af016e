// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

namespace beamgyro::internal {

/// The Cholesky decomposition A = L L^T of a symmetric, positive definite
/// matrix, n x n, of which the lower triangle is read. L is kept for any number
/// of right-hand sides, which several threads may solve for.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& A);
  ~Cholesky();

  /// Returns false if a pivot is not above 0: A is not positive definite, or
  /// not to double precision. The other functions then return what the
  /// unfinished decomposition gives, which may be any numbers. Elements of A
  /// that are not a number go unnoticed.
  bool is_positive_definite() const;

  /// Returns L, with zeros above the diagonal.
  Eigen::MatrixXd lower() const;

  /// Returns the x with A x = b, or the n x m matrix X with A X = B.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

  /// Returns A^-1.
  Eigen::MatrixXd inverse() const;

 private:
  std::unique_ptr<const Eigen::LLT<Eigen::MatrixXd>> llt_;
};

}  // namespace beamgyro::internal
