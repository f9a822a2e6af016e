// SPDX-License-Identifier: MIT
#include "linear_algebra/cholesky.h"

#include <Eigen/Cholesky>

namespace beamgyro::internal {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Cholesky::Cholesky(const MatrixXd& A)
    : llt_(std::make_unique<const Eigen::LLT<MatrixXd>>(A)) {}
Cholesky::~Cholesky() = default;

bool Cholesky::is_positive_definite() const {
  return llt_->info() == Eigen::Success;
}

MatrixXd Cholesky::lower() const { return llt_->matrixL(); }

VectorXd Cholesky::solve(const VectorXd& b) const { return llt_->solve(b); }

MatrixXd Cholesky::solve(const MatrixXd& B) const { return llt_->solve(B); }

MatrixXd Cholesky::inverse() const {
  return llt_->solve(MatrixXd::Identity(llt_->rows(), llt_->cols()));
}

}  // namespace beamgyro::internal
