// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "sim/memory/bond_relaxation.h"
#include "sim/memory/memory_parameters.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/numerics/state_archive.h"

namespace beamgyro::internal {

/// Temperature at which the effective age runs as fast as time, T_0 [K].
inline constexpr double kAgeingTemperature = 298.15;

/// Rate at which a unit is cooled from above its glass transition, and at which
/// it is brought from one place to the next before a run [K/s]: 1 K/min.
inline constexpr double kHandlingRate = 1.0 / 60;

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

  void archive(StateArchive& archive) { archive(age_); }

  double effective_age() const { return age_; }  // t_e [s]
  double decades() const;  // log10((t_e + t_1)/(t_trim + t_1))

 private:
  AgeingParameters parameters_;
  double age_;
};

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

  void archive(StateArchive& archive) { archive(temperature_, states_); }

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

/// What lies behind a unit when a run begins.
struct UnitHistory {
  std::optional<PiecewiseLinear> temperature;  // [K]; ends when the run begins
  double age = 0;  // from the trim to the begin of the run [s]
};

/// The memory states of one unit. Bond and age follow the temperature of the
/// patches, the hysteresis follows that of the beam.
class UnitMemory {
 public:
  /// Prepares a unit for a run that begins at `start` [K]:
  /// - its bond has been cooled through T_g at kHandlingRate, from 30 K above
  ///   T_g and above all later temperatures, or has T_f = T_g + initial_offset;
  /// - it has rested at 25 degC for as much of its age as lies before the
  ///   history, which is all of it where there is none;
  /// - it has been through the history.
  /// Between these it was brought from temperature to temperature, and at last
  /// to `start`, at kHandlingRate; that takes nothing of its age. Its effective
  /// age is t_trim and that of rest and history since the trim.
  UnitMemory(const MemoryParameters& parameters, double glass_transition,
             const UnitHistory& history, double start);

  /// Moves the patches from `from` to `to` [K] along a straight line.
  void advance_patches(double from, double to, double duration);
  /// Moves the beam monotonically to `T` [K].
  void push_beam(double T);

  /// The states with the patches at `patches` [K] and the beam where it was
  /// pushed last.
  MemoryState state(double patches) const;

  const std::optional<BondRelaxation>& relaxation() const {
    return relaxation_;
  }
  const std::optional<PlayOperators>& hysteresis() const { return hysteresis_; }
  double glass_transition() const { return glass_transition_; }

  void archive(StateArchive& archive);

 private:
  void bring(double from, double to);
  void live(const PiecewiseLinear& history, double age);

  double glass_transition_;
  std::optional<BondRelaxation> relaxation_;
  std::optional<PlayOperators> hysteresis_;
  std::optional<Ageing> ageing_;
};

}  // namespace beamgyro::internal
