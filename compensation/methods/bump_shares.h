// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace beamgyro::internal {

/// Returns for each resonance the share of `bumps` (one row a soak, one column
/// a resonance) in the bias at soaks at scaled temperatures t, from -1 to 1:
/// the mean over the signs -1, 0 and 1 of each, weighted by their evidence.
/// Quadrature does not tell a bump from a dip. Of what the bumps leave the
/// prior is a cubic in t, smoother the higher the power, of any size; soaks are
/// sure to `noise` [unit of the bias].
Eigen::VectorXd bump_shares(const Eigen::VectorXd& t,
                            const Eigen::VectorXd& bias,
                            const Eigen::MatrixXd& bumps, double noise);

}  // namespace beamgyro::internal
