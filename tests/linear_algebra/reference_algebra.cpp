// SPDX-License-Identifier: MIT
#include "tests/linear_algebra/reference_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace beamgyro::internal::reference {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;

// Real matrices go the way of complex ones, so that one decomposition is
// compiled; their imaginary parts stay zero.
MatrixXd solution(const RealMatrix& A, const RealMatrix& b) {
  return solution(MatrixXcd(A.cast<std::complex<double>>()),
                  MatrixXcd(b.cast<std::complex<double>>()))
      .real();
}

MatrixXcd solution(const ComplexMatrix& A, const ComplexMatrix& b) {
  return Eigen::PartialPivLU<MatrixXcd>(A).solve(MatrixXcd(b));
}

MatrixXd inverse(const RealMatrix& A) {
  return solution(A, MatrixXd::Identity(A.rows(), A.rows()));
}

MatrixXcd inverse(const ComplexMatrix& A) {
  return solution(A, MatrixXcd::Identity(A.rows(), A.rows()));
}

Eigen::VectorXd least_squares(const RealMatrix& A, const RealMatrix& b) {
  return Eigen::HouseholderQR<MatrixXd>(A).solve(MatrixXd(b));
}

MatrixXd cholesky_root(const RealMatrix& A) {
  return Eigen::LLT<MatrixXd>(A).matrixL();
}

SymmetricModes symmetric_modes(const RealMatrix& A, const RealMatrix& M) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(A, M);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricModes symmetric_modes(const RealMatrix& A) {
  return symmetric_modes(A, MatrixXd::Identity(A.rows(), A.rows()));
}

MatrixXd exponential(const RealMatrix& A) {
  return exponential(MatrixXcd(A.cast<std::complex<double>>())).real();
}

MatrixXcd exponential(const ComplexMatrix& A) {
  constexpr int kTerms = 18;  // 0.5^19 / 19! is below 1e-22
  const int squarings = std::max(0, std::ilogb(A.norm()) + 2);
  const MatrixXcd small = A * std::ldexp(1.0, -squarings);
  const MatrixXcd one = MatrixXcd::Identity(A.rows(), A.rows());
  MatrixXcd power = one;
  for (int k = kTerms; k > 0; --k) power = one + small * power / double(k);
  for (int k = 0; k < squarings; ++k) power = power * power;
  return power;
}

}  // namespace beamgyro::internal::reference
