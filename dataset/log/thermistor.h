// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "config/table.h"

namespace beamgyro::internal {

/// A resistor between the two ends of a supply and the thermistor, whose
/// reading is the share of the supply over the part at ground.
struct VoltageDivider {
  double series = 0;      // [ohm]
  double full_scale = 0;  // reading at the supply
  bool at_ground = true;  // the thermistor; else the resistor is

  /// Returns the resistance [ohm] of the thermistor; NaN for a reading outside
  /// (0, full_scale).
  double resistance(double reading) const;
};

/// A thermistor whose resistance R [ohm] has the temperature T [K] of Steinhart
/// and Hart:
///   1 / T = a + b ln R + c (ln R)^3.
/// With a constant B: c = 0, b = 1 / B, a = 1 / 298.15 - b ln R25.
struct Thermistor {
  std::array<double, 3> coefficients = {};  // a, b, c [1/K]
  std::optional<VoltageDivider> divider;    // else the reading is R

  /// Returns the temperature [degC] at a reading; NaN where there is none.
  double temperature(double reading) const;
};

/// Reads the table `thermistor` of a temperature. `is_resistance`: the column
/// has a resistance, and no divider. Throws std::invalid_argument as
/// ConfigTable.
Thermistor read_thermistor(const ConfigTable& table, bool is_resistance);

}  // namespace beamgyro::internal
