// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/network_training.h"

namespace beamgyro {

/// P = penalty mean(g^2) / 2 over the rows. g is the share of a rate that the
/// network takes for drift: from row x to x + s d, with d the change of the
/// scaled inputs with the rate in units of the scaled bias
/// (TrainOptions::rate_direction),
///
///   g = (y(x + s d) - y(x)) / s
///
/// and s |d| one of kPenaltySteps, for each row the next: a network whose slope
/// vanishes at the rows alone can still bend, or saturate, on its way to the
/// rates that training at rest never shows it.
class RatePenalty {
 public:
  /// Throws std::invalid_argument when no input changes with the rate.
  RatePenalty(const BpNetwork& network, const ScaledRows& rows,
              const TrainOptions& options);

  /// Whether there is anything to penalise.
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

/// Of the scaled inputs, whose half width is that of the training rows: from
/// the slope to a hundred times what the rows span.
constexpr double kPenaltySteps[] = {1e-3, -1.0,  10.0, -100.0,
                                    1.0,  -10.0, 100.0};

}  // namespace beamgyro
