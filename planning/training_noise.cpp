// SPDX-License-Identifier: MIT
#include "planning/training_noise.h"

#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/linear_systems.h"

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
    const MatrixXd shown = solve_system(modes, walk);
    V = shown * shown.transpose();
    V /= symmetric_eigen(V).values.maxCoeff();
  }
  const SymmetricEigen left =
      symmetric_eigen(MatrixXd::Identity(V.rows(), V.cols()) - V);
  return left.vectors * left.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         left.vectors.transpose();
}

}  // namespace beamgyro::internal
