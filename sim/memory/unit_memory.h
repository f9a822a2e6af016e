// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "sim/memory/ageing.h"
#include "sim/memory/bond_relaxation.h"
#include "sim/memory/memory_state.h"
#include "sim/memory/play_operators.h"
#include "sim/numerics/piecewise_linear.h"

namespace beamgyro::internal {

/// What lies behind a unit when a run begins.
struct UnitHistory {
  std::optional<PiecewiseLinear> temperature;  // [K]; ends where the run begins
  double age = 0;  // from the trim to the begin of the run [s]
};

/// The memory states of one unit. Bond and age follow the temperature of the
/// patches, the hysteresis follows that of the beam.
class UnitMemory {
 public:
  /// Prepares a unit for a run that begins at `start` [K]:
  /// - its bond has been cooled through T_g at 1 K/min, from 30 K above T_g and
  ///   above all later temperatures, or has T_f = T_g + initial_offset;
  /// - then it has been through `history`, or straight to `start`;
  /// - its effective age is t_trim and what has passed since the trim: at the
  ///   temperatures of the history as far as that goes back, before that at
  ///   25 degC.
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

 private:
  void live(const PiecewiseLinear& history, double age);

  double glass_transition_;
  std::optional<BondRelaxation> relaxation_;
  std::optional<PlayOperators> hysteresis_;
  std::optional<Ageing> ageing_;
};

}  // namespace beamgyro::internal
