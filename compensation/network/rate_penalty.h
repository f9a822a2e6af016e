// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// P = penalty mean(g^2) / 2 over the rows. g is the share of a rate that the
/// network mistakes for drift between row x and x + s d. d is the change of the
/// scaled inputs with the rate in units of the scaled bias
/// (TrainOptions::rate_direction):
///
///   g = (y(x + s d) - y(x)) / s
///
/// s |d| is one of kPenaltySteps, for each row the next one. A penalty on the
/// slope at the rows alone would not be enough: the network could still bend or
/// saturate on the way to rates that are not in a training at rest.
class RatePenalty {
 public:
  /// Throws std::invalid_argument when no input changes with the rate.
  RatePenalty(const BpNetwork& network, const ScaledRows& rows,
              const TrainOptions& options);

  /// Returns whether the penalty is above 0.
  bool active() const { return penalty_ > 0.0; }

  double value(const Eigen::VectorXd& w);
  /// Adds the Gauss-Newton matrix of P (lower triangle) and dP/dw at w.
  void add_to(const Eigen::VectorXd& w, Eigen::MatrixXd& matrix,
              Eigen::VectorXd& gradient);

 private:
  BpNetwork network_;
  double penalty_;
  Eigen::ArrayXXd here_, there_;  // scaled inputs x, x + s d
  Eigen::ArrayXd inverse_step_;   // 1 / s
};

/// Steps of the scaled inputs, whose half width is that of the training rows:
/// from the slope to a hundred times the span of the rows.
constexpr double kPenaltySteps[] = {1e-3, -1.0,  10.0, -100.0,
                                    1.0,  -10.0, 100.0};

}  // namespace beamgyro::internal
