// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compensation/scoring/validation.h"

namespace beamgyro::internal {

/// Returns everything in `validation`. Keys name their units; a figure that is
/// missing or not finite is null.
nlohmann::ordered_json to_json(const Validation& validation);

/// Returns a table of the residuals, one of the scale factor where rates were
/// recorded, what their columns are, and the checks. A table has one row for
/// each run, one for all together and one for the raw rate, of at most 100
/// columns; a name that is longer than its column stands above its row. The
/// columns: variance [(deg/s)^2], 1-sigma, peak-to-peak, mean, rms and largest
/// of the residual [deg/s]; percent of the cubic's variance; scale factor
/// retained within kSmallRate and over every rate, absolute slope over every
/// rate; nonlinearity [ppm]. "-" where a figure is missing.
std::string table(const Validation& validation);

/// Returns a table with one row for each method, all runs together, the raw
/// rate first: variance, 1-sigma, peak-to-peak; percent of the cubic's
/// variance; scale factor retained within kSmallRate and over every rate;
/// verdict. Throws std::invalid_argument when the methods were not scored on
/// the same runs.
std::string table(const std::vector<Validation>& methods);

}  // namespace beamgyro::internal
