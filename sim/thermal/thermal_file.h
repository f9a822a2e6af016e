// SPDX-License-Identifier: MIT
#pragma once

#include "config/table.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

/// The table [thermal] of a device file: every key of thermal_fields(), and
/// every key of oven_fields() if there is a table `oven`. Throws
/// std::invalid_argument as ConfigTable and require_valid() do.
ThermalParameters read_thermal(const ConfigTable& thermal);

}  // namespace beamgyro::internal
