// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

// Square systems by LU decomposition with partial pivoting, P A = L U. A
// singular A is not refused: the result then has elements that are infinite or
// not a number, or none of its digits is right. All functions may be called
// from several threads.
namespace beamgyro::internal {

/// Returns the X with A X = B: A is n x n, X and B are n x m.
Eigen::MatrixXd solve_system(const Eigen::MatrixXd& A,
                             const Eigen::MatrixXd& B);

/// Returns the x with A x = b, without memory of the heap. The last bits may
/// differ from those of a matrix of another type.
Eigen::Vector4d solve_system(const Eigen::Matrix4d& A,
                             const Eigen::Vector4d& b);
Eigen::Vector<double, 6> solve_system(const Eigen::Matrix<double, 6, 6>& A,
                                      const Eigen::Vector<double, 6>& b);

/// Returns A^-1 of an n x n matrix.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A);

/// Returns A^-1 = [[a11, -a01], [-a10, a00]] / (a00 a11 - a01 a10).
Eigen::Matrix2cd inverse_of(const Eigen::Matrix2cd& A);

/// L and U of one matrix after another, all n x n, each kept for any number of
/// right-hand sides. Memory is allocated once. One object serves one thread.
class LuFactors {
 public:
  explicit LuFactors(Eigen::Index n);
  ~LuFactors();

  /// Takes the factors of A. Returns false if A is singular: a pivot is 0.
  bool factorise(const Eigen::Ref<const Eigen::MatrixXd>& A);

  /// Returns the x with A x = b of the last A; valid until the next call.
  const Eigen::VectorXd& solve(const Eigen::Ref<const Eigen::VectorXd>& b);

 private:
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;
  Eigen::VectorXd x_;
};

}  // namespace beamgyro::internal
