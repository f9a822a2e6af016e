// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"

namespace beamgyro {

/// What the factory trims at 25 degC.
struct Trims {
  bool quadrature = true, offset = true, scale_factor = true;
};

/// Sets the keys of what was not trimmed to what a unit shows that was built
/// with the settings of the base unit (docs/model.md): its quadrature under the
/// base unit's k_trim, its scale factor under the base unit's gain, its output
/// at T_0 and rest under the base unit's offset. Throws SimulationFailure when
/// the drive loop does not lock.
void set_as_built(const Trims& trims, const Gyro& base, Device& device);

}  // namespace beamgyro
