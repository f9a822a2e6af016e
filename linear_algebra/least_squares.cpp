// SPDX-License-Identifier: MIT
#include "linear_algebra/least_squares.h"

#include <Eigen/QR>
#include <algorithm>

namespace beamgyro::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd upper_triangle(const Eigen::HouseholderQR<MatrixXd>& qr) {
  return qr.matrixQR()
      .topRows(std::min(qr.rows(), qr.cols()))
      .triangularView<Eigen::Upper>();
}

}  // namespace

LeastSquares least_squares(const MatrixXd& A, const VectorXd& b) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  return {qr.solve(b), qr.rank()};
}

VectorXd least_norm_solution(const MatrixXd& A, const VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

FullRankSolution full_rank_solution(const MatrixXd& A, const VectorXd& b) {
  const Eigen::HouseholderQR<MatrixXd> qr(A);
  return {qr.solve(b), upper_triangle(qr)};
}

MatrixXd upper_factor(const MatrixXd& A) {
  return upper_triangle(Eigen::HouseholderQR<MatrixXd>(A));
}

}  // namespace beamgyro::internal
