// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Returns the symmetric root R of the covariance I - V of what devices of a
/// population really are: c shows them with the slow noise of the sweeps that
/// the population was learned from, and c R has the covariance without it.
///
/// V is that of a walk of the bias along the grid, with the largest variance of
/// a step that leaves I - V no negative eigenvalue. The curves of devices are
/// smooth: what is left of their covariance in the directions in which they
/// differ least is noise. Without such directions, or with fewer modes than
/// values on the grid, nothing is taken off: R = I.
Eigen::MatrixXd truth_root(const Population& population);

}  // namespace beamgyro::internal
