// SPDX-License-Identifier: MIT
#pragma once

#include "sim/memory/memory_parameters.h"

namespace beamgyro::internal {

/// Temperature at which the effective age runs as fast as time, T_0 [K].
inline constexpr double kAgeingTemperature = 298.15;

/// dt_e/dt = exp[-(E_a/R) (1/T - 1/T_0)] at T [K].
double ageing_rate(double activation, double T);

/// The effective age of a unit, equation (12.5). A property is
///   q [1 + alpha_q log10((t_e + t_1)/(t_trim + t_1))].
class Ageing {
 public:
  /// Starts at effective age `age` >= 0 [s].
  Ageing(const AgeingParameters& parameters, double age);

  /// Advances by `duration` [s] while T goes from `from` to `to` [K] along a
  /// straight line.
  void advance(double from, double to, double duration);

  double effective_age() const { return age_; }  // t_e [s]
  double decades() const;  // log10((t_e + t_1)/(t_trim + t_1))

 private:
  AgeingParameters parameters_;
  double age_;
};

}  // namespace beamgyro::internal
