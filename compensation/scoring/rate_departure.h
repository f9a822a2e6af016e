// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamgyro::internal {

constexpr double kDriftKnots = 300.0;  // [s]
// Damping of a term, as a share of the sum of squares of that term with
// amplitude one [-].
constexpr double kDriftDamping = 1e-6;

/// Returns a rate less its least-squares line over the temperature, rate - c T,
/// both about their means.
Eigen::VectorXd without_temperature(const Eigen::VectorXd& rate,
                                    const Eigen::VectorXd& temperature);

/// Returns a rate about its mean, less the temperature and less a continuous
/// piecewise straight line over time with knots every kDriftKnots or less:
///
///   rate - c T - Σ_j p_j h_j(t),   h_j the hats over the knots.
///
/// Steps and swings of a rate remain, a drift does not. c and p_j are damped by
/// kDriftDamping, so that a rate which is itself such a line shrinks but keeps
/// its shape. `time` [s] increases and has one entry for each rate. Takes time
/// and memory in proportion to the samples.
Eigen::VectorXd without_drift(const Eigen::VectorXd& rate,
                              const Eigen::VectorXd& temperature,
                              const std::vector<double>& time);

}  // namespace beamgyro::internal
