// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "sim/memory/memory_parameters.h"
#include "sim/numerics/state_archive.h"

namespace beamgyro::internal {

/// Structural relaxation of the bond after Tool, Narayanaswamy and Moynihan,
/// equation (12.1), with all temperatures in K:
///
///   dT_fj/dt = (T - T_fj) / (a_j tau_s),   T_f = sum_j g_j T_fj,
///   tau_s(T, T_f) = 100 s exp{(dh/R) [x/T + (1 - x)/T_f - 1/T_g]}.
///
/// The six modes follow exp(-t^0.5) within 1.1 %. A step solves the modes
/// exactly for a linear course of T with tau_s taken at the middle of the step;
/// a whole step and two halves make it one of third order. It is stable for
/// every step, and no T_fj ever leaves the range of the temperatures that the
/// bond has had.
class BondRelaxation {
 public:
  static constexpr std::size_t kModes = 6;
  static constexpr std::array<double, kModes> kTimes = {
      1e-3, 6.31e-3, 3.98e-2, 0.251, 1.58, 10};  // a_j
  static constexpr double kGlassTime = 100;      // tau_s at T_g [s]

  /// Starts with every T_fj at `start` [K].
  BondRelaxation(const RelaxationParameters& parameters,
                 double glass_transition, double start);

  /// Advances by `duration` >= 0 [s] while T goes from `from` to `to` [K] along
  /// a straight line, in steps of 2 K at most, which are halved until two
  /// halves give the same T_f as the whole to kError. A cycle through the glass
  /// transition leaves T_f within 4e-4 K.
  void advance(double from, double to, double duration);
  static constexpr double kError = 5e-4;  // [K]

  double fictive_temperature() const;  // T_f [K]
  const std::array<double, kModes>& modes() const { return modes_; }

  void archive(StateArchive& archive) { archive(modes_); }

  /// tau_s at T [K] with the present T_f [s].
  double time_constant(double T) const;

  /// g_j, which add up to 1.
  static std::array<double, kModes> weights();

 private:
  using Modes = std::array<double, kModes>;
  double time_constant(double T, const Modes& modes) const;
  Modes stepped(const Modes& modes, double tau, double from, double to,
                double duration) const;
  Modes halved(const Modes& modes, double from, double to, double duration,
               int depth) const;

  double activation_over_R_;  // [K]
  double nonlinearity_;
  double glass_transition_;  // [K]
  Modes modes_;              // T_fj [K]
};

/// T_f,ref = max(T, T_g) [K].
double reference_fictive_temperature(double T, double glass_transition);

}  // namespace beamgyro::internal
