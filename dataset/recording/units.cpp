// SPDX-License-Identifier: MIT
#include "dataset/recording/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kFahrenheitZero = 32.0;                // [degF]
constexpr double kKelvinPerFahrenheitStep = 5.0 / 9.0;  // [K]

struct Unit {
  std::string_view to, name;
  UnitConversion conversion;
};

// The one table of units, of recordings and of logs alike.
constexpr std::array kUnits = {
    Unit{"degree/s", "degree/s", {}},
    Unit{"degree/s", "deg/s", {}},
    Unit{"degree/s", "degree s-1", {}},
    Unit{"degree/s", "degree/h", {0, 1.0 / 3600.0}},
    Unit{"degree/s", "deg/h", {0, 1.0 / 3600.0}},
    Unit{"degree/s", "rad/s", {0, kDegPerRad}},
    Unit{"degree/s", "rad s-1", {0, kDegPerRad}},
    Unit{"degree/s", "mrad/s", {0, 1e-3 * kDegPerRad}},
    Unit{"degC", "degC", {}},
    Unit{"degC", "Celsius", {}},
    Unit{"degC", "K", {kZeroCelsius, 1}},
    Unit{"degC", "Kelvin", {kZeroCelsius, 1}},
    Unit{"degC", "degF", {kFahrenheitZero, kKelvinPerFahrenheitStep}},
    Unit{"V", "V", {}},
    Unit{"V", "mV", {0, 1e-3}},
    Unit{"V", "uV", {0, 1e-6}},
    Unit{"Hz", "Hz", {}},
    Unit{"Hz", "kHz", {0, 1e3}},
    Unit{"Hz", "MHz", {0, 1e6}},
    Unit{"s", "s", {}},
    Unit{"s", "ms", {0, 1e-3}},
    Unit{"s", "us", {0, 1e-6}},
    Unit{"s", "ns", {0, 1e-9}},
    Unit{"s", "min", {0, 60}},
    Unit{"s", "h", {0, 3600}},
    Unit{"m/s2", "m/s2", {}},
    Unit{"m/s2", "m s-2", {}},
    Unit{"m/s2", "g", {0, kStandardGravity}},
};

}  // namespace

UnitConversion unit_conversion(std::string_view unit, std::string_view to) {
  if (unit == to) return {};
  std::string known;
  for (const Unit& one : kUnits) {
    if (one.to != to) continue;
    if (one.name == unit) return one.conversion;
    known += known.empty() ? "" : ", ";
    known += one.name;
  }
  throw std::invalid_argument(
      fmt::format("the unit '{}' is not known; expected {}", unit,
                  known.empty() ? std::string(to) : known));
}

}  // namespace beamgyro::internal
