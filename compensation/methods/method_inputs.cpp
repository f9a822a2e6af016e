// SPDX-License-Identifier: MIT
#include "compensation/methods/method_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {
namespace {

void require_one_temperature(const ConfigTable& root,
                             const std::vector<Input>& inputs,
                             const std::string& kind, bool of_samples) {
  const bool one = inputs.size() == 1 &&
                   (inputs[0] == parse_input("temperature") ||
                    (is_temperature_lowpass(inputs[0]) && !of_samples));
  if (!one)
    root.fail(
        "inputs",
        fmt::format("{} inputs starting with \"{}\"; a {} takes one "
                    "input, \"temperature\"{}",
                    inputs.size(), input_name(inputs[0]), kind,
                    of_samples ? "" : " or \"temperature_lowpass(TAU)\""));
}

void require_temperature_first(const ConfigTable& root,
                               const std::vector<Input>& inputs,
                               const std::string& kind) {
  if (inputs[0] != parse_input("temperature"))
    root.fail("inputs", fmt::format("starts with \"{}\"; the first input of a "
                                    "{} is \"temperature\"",
                                    input_name(inputs[0]), kind));
  for (const Input& input : inputs)
    if (sees_the_rate(input))
      root.fail("inputs",
                fmt::format("\"{}\" feels the rate, and a {} would take the "
                            "rate for drift; only a bp network takes it, with "
                            "rate_penalty",
                            input_name(input), kind));
}

void require_channels(const ConfigTable& root, const std::vector<Input>& inputs,
                      const std::string& kind) {
  require_temperature_first(root, inputs, kind);
  for (const Input& input : inputs)
    if (input.kind != InputKind::kColumn)
      root.fail("inputs",
                fmt::format("\"{}\"; a {} takes what a soak shows: "
                            "\"quadrature\", \"drive_voltage\" or "
                            "\"drive_frequency\" beside the temperature",
                            input_name(input), kind));
}

}  // namespace

std::vector<Input> read_inputs(const ConfigTable& root) {
  const std::vector<std::string> names = root.texts("inputs");
  if (names.empty()) root.fail("inputs", "[], needs at least one input");
  std::vector<Input> inputs;
  for (const std::string& name : names) {
    try {
      inputs.push_back(parse_input(name));
    } catch (const std::invalid_argument& error) {
      root.fail("inputs", error.what());
    }
    if (std::count(inputs.begin(), inputs.end(), inputs.back()) > 1)
      root.fail("inputs", fmt::format("\"{}\" is there twice", name));
  }
  return inputs;
}

std::vector<Input> read_inputs(const JsonNode& node) {
  std::vector<Input> inputs;
  for (const JsonNode& input : node.elements()) {
    const std::string name = input.text();
    try {
      inputs.push_back(parse_input(name));
    } catch (const std::invalid_argument& error) {
      input.fail(error.what());
    }
  }
  return inputs;
}

void check_inputs(const ConfigTable& root, const std::vector<Input>& inputs,
                  InputRule rule, const std::string& method) {
  switch (rule) {
    case InputRule::kNamed:
    case InputRule::kAny:
    case InputRule::kOfItsOwn:
      return;
    case InputRule::kTemperatureFirst:
      return require_temperature_first(root, inputs, method);
    case InputRule::kOneTemperature:
      return require_one_temperature(root, inputs, method, false);
    case InputRule::kMeasuredOnly:
      return require_one_temperature(root, inputs, method, true);
    case InputRule::kChannels:
      return require_channels(root, inputs, method);
  }
}

int distinct_temperatures(const Eigen::ArrayXd& temperature, double apart) {
  std::vector<double> sorted(temperature.begin(), temperature.end());
  std::sort(sorted.begin(), sorted.end());
  int distinct = 0;
  double last = -std::numeric_limits<double>::infinity();
  for (const double T : sorted)
    if (T - last >= apart) {
      ++distinct;
      last = T;
    }
  return distinct;
}

void check_temperatures(const Eigen::ArrayXd& temperature, int degree) {
  const int distinct = distinct_temperatures(temperature);
  if (distinct < degree + 1)
    throw UndeterminedFit(fmt::format(
        "temperature is between {:.2f} and {:.2f} degC in the training rows, "
        "{} values {} K apart; a polynomial of degree {} needs {}",
        temperature.minCoeff(), temperature.maxCoeff(), distinct,
        kDistinctTemperatures, degree, degree + 1));
}

std::vector<Scale> unscaled(const FitTask& task) {
  return std::vector<Scale>(task.inputs.size());
}

std::vector<Scale> scales_of(const FitTask& task) {
  std::vector<Scale> scales;
  for (std::size_t i = 0; i < task.inputs.size(); ++i)
    scales.push_back(
        scale_to_unit(task.rows.inputs.col(static_cast<Eigen::Index>(i)),
                      "input " + input_name(task.inputs[i])));
  return scales;
}

Eigen::ArrayXXd scaled(const Eigen::ArrayXXd& inputs,
                       const std::vector<Scale>& scales) {
  Eigen::ArrayXXd result = inputs;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) {
    const Scale& scale = scales[static_cast<std::size_t>(i)];
    result.col(i) = (inputs.col(i) - scale.centre) / scale.half_width;
  }
  return result;
}

}  // namespace beamgyro::internal
