// SPDX-License-Identifier: MIT
#include "compensation/compensator/settled_curve.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace beamgyro::internal {
namespace {

constexpr double kShareBeyond = 0.08;  // of the range, at both ends
constexpr double kLeastBeyond = 1.0;   // [K], of a range without width
constexpr Eigen::Index kPoints = 300;

bool follows_temperature(const Input& input) {
  return input.kind != InputKind::kColumn || input.column == "temperature";
}

// The values of an input at steady temperatures [degC], long after power-on.
Eigen::ArrayXd settled(const Input& input, const Eigen::ArrayXd& temperature) {
  const bool fades = input.kind == InputKind::kTemperatureRate ||
                     input.kind == InputKind::kSincePowerOn;
  return fades ? Eigen::ArrayXd::Zero(temperature.size()) : temperature;
}

nlohmann::ordered_json bias_over(const BiasModel& bias,
                                 const std::vector<Input>& inputs,
                                 const Eigen::ArrayXd& temperature) {
  Eigen::ArrayXXd x(temperature.size(), inputs.size());
  for (std::size_t k = 0; k < inputs.size(); ++k)
    x.col(static_cast<Eigen::Index>(k)) = settled(inputs[k], temperature);
  const Eigen::ArrayXd b = bias.predict(x);
  return std::span(b.data(), kPoints);
}

}  // namespace

std::string settled_curve(const FittedCompensator& compensator) {
  const auto [low, high] = compensator.temperature_range;
  const double beyond = high > low ? kShareBeyond * (high - low) : kLeastBeyond;
  const Eigen::ArrayXd temperature =
      Eigen::ArrayXd::LinSpaced(kPoints, low - beyond, high + beyond);
  const Eigen::ArrayXd clamped = temperature.max(low).min(high);
  nlohmann::ordered_json curve = {
      {"temperature_degC", std::span(temperature.data(), kPoints)},
      {"bias_deg_per_s", nullptr},
      {"cubic_deg_per_s",
       bias_over(compensator.baseline, {parse_input("temperature")}, clamped)},
      {"sigma_deg_per_s", nullptr},
      {"other_inputs", nlohmann::ordered_json::array()}};
  for (const Input& input : compensator.inputs)
    if (!follows_temperature(input))
      curve["other_inputs"].push_back(input_name(input));
  if (curve["other_inputs"].empty())
    curve["bias_deg_per_s"] =
        bias_over(compensator.bias, compensator.inputs, clamped);
  if (compensator.sigma)
    for (const double T : temperature)
      curve["sigma_deg_per_s"].push_back(compensator.sigma->at(T, 0.0, 0.0));
  return curve.dump();
}

}  // namespace beamgyro::internal
