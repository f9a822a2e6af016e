// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "sim/dynamics/gyro.h"
#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {

/// The thermal network (4.1) in steps of the classical Runge-Kutta method of
/// order 4, without a look at what comes later. A step is short enough for its
/// stability and for an error below 1e-8 K, with an oven below 1e-6 K.
class ThermalStepper {
 public:
  /// Temperatures by ThermalNode [K] and the integral of the oven [W], which is
  /// 0 for a unit without.
  using State = Eigen::Matrix<double, kThermalNodeCount + 1, 1>;

  /// Throws SimulationFailure for a network that would take more than 10,000
  /// steps a second.
  ThermalStepper(const TrimmedGyro& gyro, bool stirred);

  /// Returns the number of equal steps that `duration` [s] takes.
  std::int64_t parts(double duration) const;

  /// Returns the state a step of `duration` [s] later, while the ambient goes
  /// from `from` to `to` [K] along a straight line.
  State stepped(const State& y, double from, double to, bool powered,
                double duration) const;

  double longest_step() const { return longest_; }  // [s]

 private:
  State rate(const State& y, double ambient, bool powered) const;
  State runge_kutta(const State& y, double from, double to, bool powered,
                    double duration) const;
  int oven_range(const State& y) const;

  ThermalOde ode_;
  std::optional<ThermalOven> oven_;
  bool stirred_;
  double longest_;  // [s]
};

}  // namespace beamgyro::internal
