// SPDX-License-Identifier: MIT
#include "linear_algebra/linear_systems.h"

#include <Eigen/LU>

namespace beamgyro::internal {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solve_system(const MatrixXd& A, const MatrixXd& B) {
  return A.partialPivLu().solve(B);
}

Eigen::Vector4d solve_system(const Eigen::Matrix4d& A,
                             const Eigen::Vector4d& b) {
  return A.partialPivLu().solve(b);
}

Eigen::Vector<double, 6> solve_system(const Eigen::Matrix<double, 6, 6>& A,
                                      const Eigen::Vector<double, 6>& b) {
  return A.partialPivLu().solve(b);
}

MatrixXd inverse_of(const MatrixXd& A) { return A.inverse(); }

Eigen::Matrix2cd inverse_of(const Eigen::Matrix2cd& A) { return A.inverse(); }

LuFactors::LuFactors(Eigen::Index n)
    : lu_(std::make_unique<Eigen::PartialPivLU<MatrixXd>>(n)), x_(n) {}
LuFactors::~LuFactors() = default;

bool LuFactors::factorise(const Eigen::Ref<const MatrixXd>& A) {
  lu_->compute(A);
  return !(lu_->matrixLU().diagonal().array() == 0).any();
}

const VectorXd& LuFactors::solve(const Eigen::Ref<const VectorXd>& b) {
  x_.noalias() = lu_->permutationP() * b;
  lu_->matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(x_);
  lu_->matrixLU().triangularView<Eigen::Upper>().solveInPlace(x_);
  return x_;
}

}  // namespace beamgyro::internal
