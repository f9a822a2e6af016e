// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace beamgyro::internal {

/// Table [rows] of a model file: how samples are averaged to training rows.
struct RowOptions {
  // [s], length of the blocks that are averaged; 0 = every sample is a row
  double seconds = 60.0;
  // [K/min]; rows whose temperature changes faster are left out
  std::optional<double> steady_K_per_min;
  // [min]; a row has the temperature at which the sensor would settle with the
  // beam as it is, T - lag dT/dt
  double lag_min = 0.0;
};

}  // namespace beamgyro::internal
