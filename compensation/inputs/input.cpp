// SPDX-License-Identifier: MIT
#include "compensation/inputs/input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "config/suggestion.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {
namespace {

/// Inputs with a parameter, by the name before its bracket.
struct ParametricInput {
  InputKind kind;
  std::string_view stem, column;
  std::string_view parameter = "time constant in s";
  int usual = 100;  // value in advice
};

constexpr ParametricInput kParametric[] = {
    {InputKind::kLowpass, "temperature_lowpass", "temperature"},
    {InputKind::kTemperatureRate, "temperature_rate", "temperature"},
    {InputKind::kTemperaturePlay, "temperature_play", "temperature",
     "half-width in K", 2},
    {InputKind::kLowpass, "quadrature_lowpass", "quadrature",
     "time constant in s", 10},
    {InputKind::kLowpass, "drive_voltage_lowpass", "drive_voltage",
     "time constant in s", 10},
    {InputKind::kSincePowerOn, "since_power_on", ""}};

/// The one of that name, with or without its bracket, or null.
const ParametricInput* parametric(std::string_view name) {
  const auto* const found = std::ranges::find(
      kParametric, name.substr(0, name.find('(')), &ParametricInput::stem);
  return found == std::end(kParametric) ? nullptr : found;
}

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
  std::vector<std::string> known = plain_inputs();
  for (const ParametricInput& input : kParametric)
    known.emplace_back(input.stem);
  const std::string near = suggestion(name.substr(0, name.find('(')), known);
  std::string hint;
  if (const ParametricInput* input = parametric(name))
    hint = fmt::format("it takes one positive {}, as {}({}); ",
                       input->parameter, input->stem, input->usual);
  else if (!near.empty())
    hint = fmt::format("did you mean \"{}\"? ", near);
  throw std::invalid_argument(fmt::format(
      "input \"{}\": {}inputs are {}, temperature_lowpass(TAU), "
      "temperature_rate(TAU), quadrature_lowpass(TAU), "
      "drive_voltage_lowpass(TAU), since_power_on(TAU), TAU in s, and "
      "temperature_play(R), R in K",
      name, hint, fmt::join(plain_inputs(), ", ")));
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
  const ParametricInput* found = parametric(name);
  if (found == nullptr) reject(name);
  return {found->kind, std::string(found->column),
          parameter_of(name, found->stem)};
}

std::string input_name(const Input& input) {
  if (input.kind == InputKind::kColumn) return input.column;
  const auto* const found =
      std::ranges::find_if(kParametric, [&](const ParametricInput& one) {
        return one.kind == input.kind && one.column == input.column;
      });
  return fmt::format("{}({})", found->stem, input.parameter);
}

bool sees_the_rate(const Input& input) {
  return input.column == "output" || input.column == "rate";
}

bool is_temperature_lowpass(const Input& input) {
  return input.kind == InputKind::kLowpass && input.column == "temperature";
}

bool reads_a_signal(const Input& input) {
  return !input.column.empty() && input.column != "temperature";
}

bool filters_a_signal(const Input& input) {
  return reads_a_signal(input) && input.kind == InputKind::kLowpass;
}

std::vector<std::string> input_names(const std::vector<Input>& inputs) {
  std::vector<std::string> names;
  names.reserve(inputs.size());
  for (const Input& input : inputs) names.push_back(input_name(input));
  return names;
}

}  // namespace beamgyro::internal
