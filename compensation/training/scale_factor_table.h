// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/models/lookup_table.h"
#include "compensation/rows/run_source.h"

namespace beamgyro::internal {

/// Fits the scale factor of the gyro over temperature, relative to the nominal
/// one [-]: the slope of rate over true_rate on every plateau at which the true
/// rate varies by kTableRate or more, pooled in bins of `bin_width` [K]. The
/// runs are visited once. Throws std::invalid_argument when there is no such
/// plateau.
LookupTable fit_scale_factor(const RunSource& runs, double bin_width);

}  // namespace beamgyro::internal
