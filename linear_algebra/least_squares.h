// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

// Linear least squares by orthogonal decompositions, which never form squares:
// the x that makes |A x - b| least, where A is m x n and b has m elements. All
// functions may be called from several threads.
namespace beamgyro::internal {

struct LeastSquares {
  Eigen::VectorXd x;
  /// Of A, counting the pivots above n eps times the largest.
  Eigen::Index rank;
};

/// Solves by QR with column pivoting. If the rank is below n, x is 0 at the
/// columns that the pivoting left to the end.
LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Returns, of all x that make |A x - b| least, that of the least norm: A may
/// have any rank. By the complete orthogonal decomposition.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& A,
                                    const Eigen::VectorXd& b);

/// x and the upper triangular R of A = Q R, n x n, without pivoting.
struct FullRankSolution {
  Eigen::VectorXd x;
  Eigen::MatrixXd R;  // R^T R = A^T A
};

/// Solves with an A of the rank n, m >= n. Another rank is not refused: x then
/// has elements that are infinite or not a number, or any numbers.
FullRankSolution full_rank_solution(const Eigen::MatrixXd& A,
                                    const Eigen::VectorXd& b);

/// Returns the R of A = Q R, min(m, n) x n, zero below the diagonal. The signs
/// of its rows are any. A may have any rank.
Eigen::MatrixXd upper_factor(const Eigen::MatrixXd& A);

}  // namespace beamgyro::internal
