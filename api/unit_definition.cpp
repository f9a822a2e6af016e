// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "api/model_description.h"
#include "config/units.h"
#include "sim/signal/loop_channels.h"

namespace beamgyro::internal {
namespace {

constexpr std::array kBaseUnits = {"kg", "m", "s", "A", "K", "mol", "rad"};

// A unit as a product of powers of base units.
struct UnitPowers {
  std::string_view name;
  double factor;
  std::array<int, kBaseUnits.size()> powers;
};
constexpr UnitPowers kUnitPowers[] = {
    {"1", 1, {}},
    {"1e-6", 1e-6, {}},
    {"kg", 1, {1}},
    {"m", 1, {0, 1}},
    {"m2", 1, {0, 2}},
    {"m3", 1, {0, 3}},
    {"s", 1, {0, 0, 1}},
    {"s2", 1, {0, 0, 2}},
    {"min", 60, {0, 0, 1}},
    {"h", 3600, {0, 0, 1}},
    {"year", kYear, {0, 0, 1}},
    {"Hz", 1, {0, 0, -1}},
    {"K", 1, {0, 0, 0, 0, 1}},
    {"K2", 1, {0, 0, 0, 0, 2}},
    {"mol", 1, {0, 0, 0, 0, 0, 1}},
    {"rad", 1, {0, 0, 0, 0, 0, 0, 1}},
    {"degree", kDegree, {0, 0, 0, 0, 0, 0, 1}},
    {"N", 1, {1, 1, -2}},
    {"Pa", 1, {1, -1, -2}},
    {"J", 1, {1, 2, -2}},
    {"W", 1, {1, 2, -3}},
    {"V", 1, {1, 2, -3, -1}},
    {"F", 1, {-1, -2, 4, 2}},
    {"C", 1, {0, 0, 1, 1}},
    {"g", kStandardGravity, {0, 1, -2}},
    {"g2", kStandardGravity* kStandardGravity, {0, 2, -4}},
};

// Multiplies `product` by a unit to the power 1 or -1; false: not known.
bool take_unit(std::string_view name, int power, UnitPowers& product) {
  const auto* const unit =
      std::ranges::find(kUnitPowers, name, &UnitPowers::name);
  if (unit == std::end(kUnitPowers)) return false;
  product.factor =
      power > 0 ? product.factor * unit->factor : product.factor / unit->factor;
  for (std::size_t i = 0; i < product.powers.size(); ++i)
    product.powers[i] += power * unit->powers[i];
  return true;
}

bool take_product(std::string_view text, UnitPowers& product) {
  int power = 1;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('/'), text.size());
    std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (part.starts_with('(')) part = part.substr(1, part.size() - 2);
    while (!part.empty()) {  // "W/(m K)"
      const std::size_t space = std::min(part.find(' '), part.size());
      if (!take_unit(part.substr(0, space), power, product)) return false;
      part.remove_prefix(std::min(space + 1, part.size()));
    }
    power = -1;
  }
  return true;
}

}  // namespace

std::string unit_definition(const std::string& unit) {
  if (unit == "degC")
    return fmt::format(
        "<Unit name=\"degC\"><BaseUnit K=\"1\" offset=\"{}\"/></Unit>",
        kZeroCelsius);
  UnitPowers product{unit, 1, {}};
  if (!take_product(unit, product))
    return fmt::format("<Unit name=\"{}\"/>", unit);
  std::string base;
  for (std::size_t i = 0; i < kBaseUnits.size(); ++i)
    if (product.powers[i] != 0)
      base += fmt::format(" {}=\"{}\"", kBaseUnits[i], product.powers[i]);
  if (product.factor != 1)
    base += fmt::format(" factor=\"{}\"", product.factor);
  return fmt::format("<Unit name=\"{}\"><BaseUnit{}/></Unit>", unit, base);
}

}  // namespace beamgyro::internal
