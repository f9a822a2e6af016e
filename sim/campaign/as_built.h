// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Which quantities the factory trims at 25 degC.
struct Trims {
  bool quadrature = true, offset = true, scale_factor = true;
};

/// Sets the keys of the quantities that were not trimmed. A unit without a trim
/// keeps the setting of the base unit (docs/model.md), so the keys become:
/// - its quadrature under the base unit's k_trim;
/// - its scale factor under the base unit's gain;
/// - its output at T_0 and rest under the base unit's offset.
/// Throws SimulationFailure when the drive loop does not lock.
void set_as_built(const Trims& trims, const Gyro& base,
                  DeviceParameters& device);

}  // namespace beamgyro::internal
