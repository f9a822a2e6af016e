// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamgyro {

constexpr double kDriftKnots = 300.0;  // [s]
// Of the sum of squares of a term of amplitude one [-].
constexpr double kDriftDamping = 1e-6;

/// What a least-squares line over the temperature leaves of a rate, both about
/// their means: rate - c T.
Eigen::VectorXd without_temperature(const Eigen::VectorXd& rate,
                                    const Eigen::VectorXd& temperature);

/// What the temperature and a continuous line over time, broken every
/// kDriftKnots or less, leave of a rate about its mean:
///
///   rate - c T - Σ_j p_j h_j(t),   h_j the hats over the knots.
///
/// Steps and swings of a rate are left, a drift is not. c and p_j are damped by
/// kDriftDamping, so that a rate which is itself such a line shrinks but keeps
/// its shape. `time` [s] increases, one per rate. Takes time and memory in
/// proportion to the samples.
Eigen::VectorXd without_drift(const Eigen::VectorXd& rate,
                              const Eigen::VectorXd& temperature,
                              const std::vector<double>& time);

}  // namespace beamgyro
