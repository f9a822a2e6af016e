// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/lookup_table.h"
#include "compensation/run_source.h"

namespace beamgyro {

/// The gyro's scale factor over its nominal one at each temperature [-]: the
/// slope of rate over true_rate from every plateau at which the true rate
/// varies by kTableRate or more, together in bins of `bin_width` [K]. The runs
/// are visited once.
/// Throws std::invalid_argument when there is no such plateau.
LookupTable fit_scale_factor(const RunSource& runs, double bin_width);

}  // namespace beamgyro
