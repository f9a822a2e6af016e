// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/models/lookup_table.h"

namespace beamgyro::internal {

/// A bias over the temperature t of the beam:
///
///   b(t) = lines(t) + Σ_k shares_k bumps_k(t)
struct LinesAndBumps {
  LookupTable lines;
  Eigen::VectorXd shares;
  double rms = 0.0;  // of the residual, unit of the bias
};

/// Fits lines between even knots `spacing` or less apart, from the least t to
/// the largest, and shares together to the bias of each row by least squares.
/// `bumps` has a row for each t and a column for each bump.
///
/// A share has a prior of mean 0 and sigma 1, a kink of the lines one of mean 0
/// and the sigma of the bias, so a knot without rows lies on a straight line
/// between others. Both count with the variance that the rows leave. Throws
/// std::invalid_argument without rows or for a spacing not above 0.
LinesAndBumps fit_lines_and_bumps(const Eigen::ArrayXd& t,
                                  const Eigen::ArrayXd& bias,
                                  const Eigen::MatrixXd& bumps, double spacing);

}  // namespace beamgyro::internal
