// SPDX-License-Identifier: MIT
#pragma once

#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// Returns whether ceramic and bond stand a temperature [K]: whether it lies in
/// kMaterialTemperatures, to the rounding of an integration.
bool materials_stand(double temperature);

/// Throws SimulationFailure for the first node [K] that the materials do not
/// stand at `t` [s]. The message names it, the ambient [K] and the power of the
/// electronics [W].
void check_materials(double t, const NodeVector& nodes, double ambient,
                     double electronics_power);

}  // namespace beamgyro::internal
