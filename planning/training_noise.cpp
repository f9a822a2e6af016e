// SPDX-License-Identifier: MIT
#include "planning/training_noise.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace beamgyro::internal {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd truth_root(const Population& population) {
  const MatrixXd& modes = population.modes;
  const Index size = modes.rows(), steps = population.grid() - 1;
  MatrixXd V = MatrixXd::Zero(modes.cols(), modes.cols());
  if (modes.cols() == size) {
    // Each step of the walk moves all values of the bias beyond it.
    MatrixXd walk = MatrixXd::Zero(size, steps);
    for (Index step = 0; step < steps; ++step)
      walk.col(step).segment(step + 1, steps - step).setOnes();
    const MatrixXd shown = modes.partialPivLu().solve(walk);
    V = shown * shown.transpose();
    V /= Eigen::SelfAdjointEigenSolver<MatrixXd>(V, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .maxCoeff();
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> left(
      MatrixXd::Identity(V.rows(), V.cols()) - V);
  return left.eigenvectors() *
         left.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         left.eigenvectors().transpose();
}

}  // namespace beamgyro::internal
