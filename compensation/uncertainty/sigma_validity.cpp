// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compensation/models/parameter_json.h"
#include "dataset/recording/signals.h"
#include "dataset/recording/stated_values.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kWay = "temperature_way";
constexpr const char* kAge = "age_hours";

// Whether a measured temperature goes that way by kLeastWay without power lost.
bool goes(TemperatureWay way, const Recording& recording) {
  const Column* temperature = find_column(recording, "temperature");
  if (temperature == nullptr) return false;
  const double sign = way == TemperatureWay::kRising ? 1.0 : -1.0;
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < temperature->values.size(); ++k) {
    const bool powered = (recording.status[k] & kUnpowered) == 0;
    const double T = sign * temperature->values[k];
    least = powered ? std::min(least, T) : HUGE_VAL;
    if (powered && T - least >= kLeastWay) return true;
  }
  return false;
}

}  // namespace

std::string way_name(TemperatureWay way) {
  return way == TemperatureWay::kRising ? "rising" : "falling";
}

bool may_remember(const Recording& recording) {
  return recording.device_text.empty() ||
         states_device_table(recording, "memory");
}

std::optional<double> stated_age(const Recording& recording) {
  if (!states_device_table(recording, "memory") &&
      !states_scenario_table(recording, "age"))
    return std::nullopt;
  return stated_scenario_number(recording, "age.hours").value_or(0.0);
}

std::vector<std::string> reasons_against_sigma(const SigmaValidity& validity,
                                               const Recording& recording) {
  std::vector<std::string> reasons;
  if (validity.only_way) {
    const TemperatureWay other = *validity.only_way == TemperatureWay::kRising
                                     ? TemperatureWay::kFalling
                                     : TemperatureWay::kRising;
    if (goes(other, recording))
      reasons.push_back(fmt::format(
          "sigma does not hold of {} temperatures: those of training were "
          "{} alone, which show no hysteresis",
          way_name(other), way_name(*validity.only_way)));
  }
  const std::optional<double> age = stated_age(recording);
  if (validity.age && age && *age > *validity.age + kSigmaLifetime)
    reasons.push_back(fmt::format(
        "sigma does not hold: the unit is {:g} h old, and that of training was "
        "{:g} h; sigma is for {:g} h more",
        *age, *validity.age, kSigmaLifetime));
  return reasons;
}

nlohmann::ordered_json sigma_validity_json(const SigmaValidity& validity) {
  nlohmann::ordered_json json;
  if (validity.only_way) json[kWay] = way_name(*validity.only_way);
  if (validity.age) json[kAge] = finite_json(*validity.age);
  return json;
}

SigmaValidity read_sigma_validity(const JsonNode& node) {
  node.require_only({kWay, kAge});
  SigmaValidity validity;
  if (node.has(kWay)) {
    const std::string name = node.at(kWay).text();
    for (const TemperatureWay way :
         {TemperatureWay::kRising, TemperatureWay::kFalling})
      if (name == way_name(way)) validity.only_way = way;
    if (!validity.only_way)
      node.at(kWay).fail(
          fmt::format("\"{}\", must be \"rising\" or \"falling\"", name));
  }
  if (node.has(kAge)) {
    const double age = node.at(kAge).number();
    if (!(age >= 0.0))
      node.at(kAge).fail(fmt::format("{}, must not be below 0", age));
    validity.age = age;
  }
  return validity;
}

}  // namespace beamgyro::internal
