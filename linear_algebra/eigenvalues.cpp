// SPDX-License-Identifier: MIT
#include "linear_algebra/eigenvalues.h"

#include <Eigen/Eigenvalues>

namespace beamgyro::internal {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& A) {
  return A.eigenvalues();
}

}  // namespace beamgyro::internal
