// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Returns the static characteristic of a gyro at rest as CSV text: a line of
/// names with units, then a line for each beam temperature [degC]. Free of
/// noise: bias and its two parts, drive frequency, split of the modes, quality
/// factors, drive voltage and scale factor.
std::string characteristic_csv(const Gyro& gyro,
                               std::span<const double> temperatures);

}  // namespace beamgyro::internal
