// SPDX-License-Identifier: MIT
#include "compensation/inputs/input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "config/suggestion.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kLowpass = "temperature_lowpass";
constexpr std::string_view kTemperatureRate = "temperature_rate";
constexpr std::string_view kTemperaturePlay = "temperature_play";
constexpr std::string_view kSincePowerOn = "since_power_on";

const std::vector<std::string>& plain_inputs() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> measured;
    for (const RecordedSignal& one : recorded_signals())
      if (one.role == Role::kMeasured) measured.emplace_back(one.name);
    return measured;
  }();
  return names;
}

[[noreturn]] void reject(std::string_view name) {
  const std::string_view stem = name.substr(0, name.find('('));
  std::vector<std::string> known = plain_inputs();
  known.emplace_back(kLowpass);
  known.emplace_back(kTemperatureRate);
  known.emplace_back(kTemperaturePlay);
  known.emplace_back(kSincePowerOn);
  const std::string near = suggestion(stem, known);
  std::string hint;
  if (stem == kLowpass || stem == kTemperatureRate || stem == kSincePowerOn)
    hint = fmt::format("it takes one positive time constant in s, as {}(100); ",
                       stem);
  else if (stem == kTemperaturePlay)
    hint =
        fmt::format("it takes one positive half-width in K, as {}(2); ", stem);
  else if (!near.empty())
    hint = fmt::format("did you mean \"{}\"? ", near);
  throw std::invalid_argument(fmt::format(
      "input \"{}\": {}inputs are {}, {}(TAU), {}(TAU), {}(TAU), TAU in s, and "
      "{}(R), R in K",
      name, hint, fmt::join(plain_inputs(), ", "), kLowpass, kTemperatureRate,
      kSincePowerOn, kTemperaturePlay));
}

// The number of "stem(NUMBER)".
double parameter_of(std::string_view name, std::string_view stem) {
  if (name.size() < stem.size() + 3 || name[stem.size()] != '(' ||
      name.back() != ')')
    reject(name);
  const std::string_view number =
      name.substr(stem.size() + 1, name.size() - stem.size() - 2);
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() ||
      !std::isfinite(value) || value <= 0.0)
    reject(name);
  return value;
}

}  // namespace

Input parse_input(std::string_view name) {
  for (const std::string& plain : plain_inputs())
    if (name == plain) return {InputKind::kColumn, plain, 0.0};
  const std::string_view stem = name.substr(0, name.find('('));
  if (stem == kLowpass)
    return {InputKind::kTemperatureLowpass, "temperature",
            parameter_of(name, stem)};
  if (stem == kTemperatureRate)
    return {InputKind::kTemperatureRate, "temperature",
            parameter_of(name, stem)};
  if (stem == kTemperaturePlay)
    return {InputKind::kTemperaturePlay, "temperature",
            parameter_of(name, stem)};
  if (stem == kSincePowerOn)
    return {InputKind::kSincePowerOn, "", parameter_of(name, stem)};
  reject(name);
}

std::string input_name(const Input& input) {
  switch (input.kind) {
    case InputKind::kTemperatureLowpass:
      return fmt::format("{}({})", kLowpass, input.parameter);
    case InputKind::kTemperatureRate:
      return fmt::format("{}({})", kTemperatureRate, input.parameter);
    case InputKind::kTemperaturePlay:
      return fmt::format("{}({})", kTemperaturePlay, input.parameter);
    case InputKind::kSincePowerOn:
      return fmt::format("{}({})", kSincePowerOn, input.parameter);
    case InputKind::kColumn:
      break;
  }
  return input.column;
}

bool sees_the_rate(const Input& input) {
  return input.column == "output" || input.column == "rate";
}

std::vector<std::string> input_names(const std::vector<Input>& inputs) {
  std::vector<std::string> names;
  names.reserve(inputs.size());
  for (const Input& input : inputs) names.push_back(input_name(input));
  return names;
}

}  // namespace beamgyro::internal
