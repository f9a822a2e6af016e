// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro {

/// A number in some unit becomes one in another:
///   value = (number - offset) scale.
struct UnitConversion {
  double offset = 0, scale = 1;

  bool is_identity() const { return offset == 0.0 && scale == 1.0; }
  double operator()(double number) const { return (number - offset) * scale; }
};

/// From `unit`, by any of its names, to `to`: degree/s, degC, V, Hz, s or m/s2,
/// as recordings have them, or to itself. Throws std::invalid_argument for
/// another unit, with those there are.
UnitConversion unit_conversion(std::string_view unit, std::string_view to);

/// The unit in which a recording holds the variable of this name; empty for a
/// variable that beamgyro does not know.
std::string_view unit_of_variable(std::string_view name);

}  // namespace beamgyro
