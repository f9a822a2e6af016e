// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compensation/validation.h"

namespace beamgyro {

/// Everything in `validation`, keys with their units; null where a figure is
/// missing or not finite.
nlohmann::ordered_json to_json(const Validation& validation);

/// One row a run, one for all together and one for the raw rate; the checks
/// below. Columns: run; variance [(deg/s)^2], 1-sigma, peak-to-peak, mean, rms
/// and largest of the residual [deg/s]; percent of the cubic's variance; scale
/// factor retained within kSmallRate and over every rate, absolute slope over
/// every rate; nonlinearity [ppm]. "-" where a figure is missing.
std::string table(const Validation& validation);

/// One row a method, all runs together, the raw rate first: variance, 1-sigma,
/// peak-to-peak; percent of the cubic's variance; scale factor retained within
/// kSmallRate and over every rate; verdict. Throws std::invalid_argument when
/// the methods were not scored on the same runs.
std::string table(const std::vector<Validation>& methods);

}  // namespace beamgyro
