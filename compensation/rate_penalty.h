// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/network_training.h"

namespace beamgyro {

/// P = penalty mean(g^2) / 2 over the rows, g = dy/ds with the inputs running
/// along TrainOptions::rate_direction: the share of the rate that a network
/// takes for drift. g and its change with the weights are central differences
/// over 1e-3 of the scaled inputs to either side.
class RatePenalty {
 public:
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
  double step_ = 0.0;               // of s, to either side
  Eigen::ArrayXXd behind_, ahead_;  // inputs at s = -step, +step
};

}  // namespace beamgyro
