// SPDX-License-Identifier: MIT
#include "sim/campaign/parameter_units.h"

#include <fmt/format.h>

#include <map>

namespace beamgyro::internal {
namespace {

using Names = std::map<std::string_view, std::string_view>;

const Names kUnits = {
    {"deg", "degree"}, {"degC", "degC"},  {"rad", "rad"},  {"K", "K"},
    {"K2", "K2"},      {"m", "m"},        {"m2", "m2"},    {"m3", "m3"},
    {"s", "s"},        {"hours", "h"},    {"min", "min"},  {"Hz", "Hz"},
    {"V", "V"},        {"F", "F"},        {"C", "C"},      {"N", "N"},
    {"Pa", "Pa"},      {"W", "W"},        {"J", "J"},      {"kg", "kg"},
    {"mol", "mol"},    {"g", "g"},        {"g2", "g2"},    {"mK", "(m K)"},
    {"m2K", "(m2 K)"}, {"kgK", "(kg K)"}, {"ppm", "1e-6"}, {"year", "year"}};

// Takes the last part of the key: "K" of "tc_rad_per_K".
std::string_view take_last(std::string_view& key) {
  const std::size_t bar = key.rfind('_');
  const std::string_view last =
      key.substr(bar == std::string_view::npos ? 0 : bar + 1);
  key = key.substr(0, bar == std::string_view::npos ? 0 : bar);
  return last;
}

}  // namespace

std::string units_of(std::string_view key) {
  if (const std::size_t dot = key.rfind('.'); dot != key.npos)
    key.remove_prefix(dot + 1);
  std::string units;  // from the back: "/s" and so on
  bool divided = true;
  while (divided) {
    const auto unit = kUnits.find(take_last(key));
    if (unit == kUnits.end()) return units.empty() ? "1" : '1' + units;
    std::string name(unit->second);
    std::string_view rest = key;
    std::string_view word = take_last(rest);
    if (word == "sqrt") {
      name = fmt::format("sqrt({})", name);
      key = rest;
      word = take_last(rest);
    }
    divided = word == "per";
    units = fmt::format("{}{}{}", divided ? "/" : "", name, units);
    if (divided) key = rest;
  }
  return units;
}

}  // namespace beamgyro::internal
