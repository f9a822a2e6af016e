// SPDX-License-Identifier: MIT
#include "compensation/compensator/compensator.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace beamgyro::internal {
namespace {

// Keeps the intermediate arrays in the cache; the result does not depend on it.
constexpr Eigen::Index kFeatureBlockRows = 4096;

std::vector<double> corrected_rate(const BiasModel& bias,
                                   const std::vector<Input>& inputs,
                                   const TemperatureRange& range,
                                   const Recording& recording) {
  std::vector<double> rate = column_values(recording, "rate");
  const Eigen::ArrayXXd x = features_of(inputs, recording, range);
  for (Eigen::Index first = 0; first < x.rows(); first += kFeatureBlockRows) {
    const Eigen::Index count = std::min(kFeatureBlockRows, x.rows() - first);
    const Eigen::ArrayXd b = bias.predict(x.middleRows(first, count));
    Eigen::Map<Eigen::ArrayXd>(rate.data() + first, count) -= b;
  }
  // Not every kind of model answers NaN to NaN.
  for (std::size_t k = 0; k < rate.size(); ++k)
    if ((recording.status[k] & kUnpowered) != 0) rate[k] = NAN;
  return rate;
}

// Divides by s of the measured temperature.
std::vector<double> over_scale_factor(std::vector<double> rate,
                                      const FittedCompensator& compensator,
                                      const Recording& recording) {
  if (!compensator.scale_factor) return rate;
  // Clamped, and an error where it is not finite.
  const Eigen::ArrayXXd temperature = features_of(
      {parse_input("temperature")}, recording, compensator.temperature_range);
  for (std::size_t k = 0; k < rate.size(); ++k)
    rate[k] /=
        compensator.scale_factor->at(temperature(static_cast<Eigen::Index>(k)));
  return rate;
}

constexpr double kShareBeyond = 0.08;  // of the range, at both ends
constexpr double kLeastBeyond = 1.0;   // [K], of a range without width
constexpr Eigen::Index kPoints = 300;

bool follows_temperature(const Input& input) { return !reads_a_signal(input); }

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

std::vector<double> compensated_rate(const FittedCompensator& compensator,
                                     const Recording& recording) {
  return over_scale_factor(
      corrected_rate(compensator.bias, compensator.inputs,
                     compensator.temperature_range, recording),
      compensator, recording);
}

std::vector<double> compensated_rate_sigma(const FittedCompensator& compensator,
                                           const Recording& recording) {
  if (!compensator.sigma) return {};
  return over_scale_factor(sigma_of(*compensator.sigma, recording), compensator,
                           recording);
}

std::vector<double> baseline_rate(const FittedCompensator& compensator,
                                  const Recording& recording) {
  return corrected_rate(compensator.baseline, {parse_input("temperature")},
                        compensator.temperature_range, recording);
}

std::vector<double> straight_lines_rate(const FittedCompensator& compensator,
                                        const Recording& recording) {
  return corrected_rate({{Scale{}}, {}, compensator.straight_lines.value()},
                        {parse_input("temperature")},
                        compensator.temperature_range, recording);
}

std::size_t clamped_samples(const FittedCompensator& compensator,
                            const Recording& recording) {
  const std::vector<double>& temperature =
      column_values(recording, "temperature");
  const TemperatureRange& range = compensator.temperature_range;
  std::size_t count = 0;
  for (std::size_t k = 0; k < temperature.size(); ++k)
    if ((recording.status[k] & kUnpowered) == 0 &&
        (temperature[k] < range.lowest || temperature[k] > range.highest))
      ++count;
  return count;
}

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
      {"straight_lines_deg_per_s", nullptr},
      {"sigma_deg_per_s", nullptr},
      {"other_inputs", nlohmann::ordered_json::array()}};
  for (const Input& input : compensator.inputs)
    if (!follows_temperature(input))
      curve["other_inputs"].push_back(input_name(input));
  if (curve["other_inputs"].empty())
    curve["bias_deg_per_s"] =
        bias_over(compensator.bias, compensator.inputs, clamped);
  if (compensator.straight_lines) {
    const Eigen::ArrayXd lines = compensator.straight_lines->predict(clamped);
    curve["straight_lines_deg_per_s"] = std::span(lines.data(), kPoints);
  }
  if (compensator.sigma)
    for (const double T : temperature)
      curve["sigma_deg_per_s"].push_back(compensator.sigma->at(T, 0.0, 0.0));
  return curve.dump();
}

}  // namespace beamgyro::internal
