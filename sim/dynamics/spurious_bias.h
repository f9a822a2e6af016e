// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Returns whether a static response depends on more than the temperature of
/// the beam because of spurious modes: on that of the housing, which some of
/// them follow, or on the memory of the unit, which moves their crossings. A
/// StaticMap does not hold it then.
bool needs_exact_solution(const TrimmedGyro& gyro);

/// The part of the zero-rate output that comes from the spurious modes of a
/// unit: its output less that of the same unit without them, both trimmed
/// alike.
class SpuriousBias {
 public:
  /// `gyro`, which has spurious modes, must outlive the object.
  explicit SpuriousBias(const TrimmedGyro& gyro)
      : gyro_(gyro), without_(without_spurious_modes(gyro)) {}

  /// Returns it [rad/s] for the demodulated signals at rest [rad/s] with and
  /// without spurious modes.
  double of(Complex with, Complex without, const Electronics& board) const {
    return ((with - without) * board.turn).real() + gyro_.offset -
           without_.offset;
  }

  /// The same by the exact solution of the unit without. `motion` has no rate
  /// about the input axis.
  double at(Complex with, const SpuriousTemperatures& temperatures,
            const MemoryState& memory, const CaseMotion& motion,
            const Electronics& board);

  /// The same with both solved exactly, of a unit at rest.
  double at_rest(const SpuriousTemperatures& temperatures,
                 const MemoryState& memory, const Electronics& board);

 private:
  const TrimmedGyro& gyro_;
  TrimmedGyro without_;
  LockPath path_, path_without_;
};

}  // namespace beamgyro::internal
