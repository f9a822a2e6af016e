// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// A made-up bias [deg/s] of the temperature [degC] with two relaxations on top
/// of a parabola: 3.9 deg/s p-p over -40 ... 50 degC, 4 extrema, a feature
/// 20 K wide. It is no tanh network, no spline and no polynomial.
double bias_curve(double temperature);

Eigen::ArrayXd bias_curve(const Eigen::ArrayXd& temperature);

/// low, low + step, ..., high
Eigen::ArrayXd grid(double low, double high, double step);

/// Points of bias_curve() with white label noise [deg/s] as a training set:
/// temperature scaled by 45 K about 5 degC, bias by 2 deg/s about 2.4 deg/s.
ScaledRows curve_rows(const Eigen::ArrayXd& temperature, double noise,
                      std::uint32_t run);

constexpr double kCurveUnit = 2.0;  // [deg/s] per unit of curve_rows().target

}  // namespace beamgyro::internal
