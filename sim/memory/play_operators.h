// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/memory/memory_parameters.h"

namespace beamgyro::internal {

/// Rate-independent hysteresis of Prandtl and Ishlinskii, equation (12.3). Each
/// play operator follows the temperature only when it is pushed:
///
///   p_i <- min(max(p_i, T - r_i), T + r_i),   h = sum_i w_i (p_i - T).
///
/// h is -h_max after a long rise and +h_max after a long fall, h_max = sum_i
/// w_i r_i. The result is exact when push() is called with every turning point
/// of T.
class PlayOperators {
 public:
  using States = std::array<double, kPlayOperators>;  // p_i [K]

  /// Starts at rest at T = `start` [K], with h = 0.
  PlayOperators(const HysteresisParameters& parameters, double start);

  /// Moves T monotonically to `T` [K].
  void push(double T);

  const States& states() const { return states_; }

  /// h [K] after a monotone move of T from where `states` were left to `T`.
  double value(const States& states, double T) const;
  double value() const;                        // h at the present T [K]
  double largest() const { return largest_; }  // h_max [K]
  double share() const;                        // h/h_max
  double share(const States& states, double T) const;

 private:
  HysteresisParameters parameters_;
  double largest_ = 0;
  double temperature_;
  States states_;
};

}  // namespace beamgyro::internal
