// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/even_series.h"
#include "compensation/scoring/noise_coefficients.h"

namespace beamgyro::internal {

/// Returns a line about the samples that are used and those that are not.
std::string series_line(const EvenSeries& series);

/// Returns a table of the deviations in `unit`, a line for each tau, with the
/// 95 % interval of the last curve. "-" is a deviation that there is not.
std::string deviation_table(const std::vector<DeviationSeries>& curves,
                            const std::string& unit);

/// Returns the noise coefficients of a series in `unit` and what the fit of
/// them used, line by line.
std::string noise_table(const NoiseCoefficients& found,
                        const std::string& unit);

}  // namespace beamgyro::internal
