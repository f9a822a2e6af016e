// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Converts a number from one unit to another:
///   value = (number - offset) scale.
struct UnitConversion {
  double offset = 0, scale = 1;

  bool is_identity() const { return offset == 0.0 && scale == 1.0; }
  double operator()(double number) const { return (number - offset) * scale; }
};

/// Returns the conversion from `unit`, by any of its names, to `to`, a unit of
/// recordings (degree/s, degC, V, Hz, s, m/s2) or the same unit. Throws
/// std::invalid_argument for any other unit and lists those that are known.
UnitConversion unit_conversion(std::string_view unit, std::string_view to);

}  // namespace beamgyro::internal
