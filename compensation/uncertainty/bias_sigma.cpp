// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/bias_sigma.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compensation/models/array_view.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

double time_constant_of(const std::optional<SigmaTerm>& term) {
  return term ? term->time_constant : kSigmaTimeConstant;
}

// In the order of SigmaSource.
constexpr std::string_view kSources[] = {"posterior", "covariance",
                                         "residuals"};
constexpr std::string_view kPowerOnAmplitude = "sigma_deg_per_s";
constexpr std::string_view kRateAmplitude = "sigma_deg_per_s_per_K_per_s";
constexpr long kMostGroups = 1000000000;

Json term_json(const SigmaTerm& term, std::string_view amplitude) {
  return {{std::string(amplitude), finite_json(term.amplitude)},
          {"time_constant_s", finite_json(term.time_constant)}};
}

std::optional<SigmaTerm> read_term(const JsonNode& sigma,
                                   const std::string& name,
                                   std::string_view amplitude) {
  if (!sigma.has(name)) return std::nullopt;
  const JsonNode node = sigma.at(name);
  node.require_only({amplitude, "time_constant_s"});
  const JsonNode value = node.at(std::string(amplitude));
  const double number = value.number();
  if (!(number >= 0.0))
    value.fail(fmt::format("{}, must not be below 0", number));
  return SigmaTerm{number, read_positive(node.at("time_constant_s"))};
}

// Far from the least and the largest double, so that its square is neither 0
// nor infinite.
double read_sized(const JsonNode& node) {
  constexpr double kLeast = 1e-12, kMost = 1e12;
  const double number = read_positive(node);
  if (number < kLeast || number > kMost)
    node.fail(
        fmt::format("{}, must lie within {:g} to {:g}", number, kLeast, kMost));
  return number;
}

SigmaSource read_source(const JsonNode& node) {
  const auto* const found = std::ranges::find(kSources, node.text());
  if (found == std::end(kSources))
    node.fail(fmt::format("\"{}\", must be \"{}\"", node.text(),
                          fmt::join(kSources, "\", \"")));
  return static_cast<SigmaSource>(found - kSources);
}

SigmaCalibration read_calibration(const JsonNode& node) {
  node.require_only({"method", "by", "groups", "level", "half_width"});
  SigmaCalibration calibration{
      node.at("method").text(), node.at("by").text(),
      static_cast<std::size_t>(node.at("groups").integer(0, kMostGroups)),
      node.at("level").number()};
  if (!(calibration.level >= 0.0 && calibration.level < 1.0))
    node.at("level").fail(
        fmt::format("{}, must be 0 or above and below 1", calibration.level));
  calibration.half_width = read_half_width(node);
  return calibration;
}

LookupTable read_curve(const JsonNode& node) {
  const JsonNode temperatures = node.at("temperature_degC");
  const JsonNode sigmas = node.at("sigma_deg_per_s");
  LookupTable curve{read_array(temperatures), read_array(sigmas)};
  const Eigen::ArrayXd& T = curve.temperatures;
  if (T.size() < 1) temperatures.fail("[], must have at least one temperature");
  if (!(T.tail(T.size() - 1) > T.head(T.size() - 1)).all())
    temperatures.fail("must increase");
  if (curve.values.size() != T.size())
    sigmas.fail(fmt::format("{} values for {} temperatures, must be as many",
                            curve.values.size(), T.size()));
  for (const JsonNode& each : sigmas.elements()) read_sized(each);
  return curve;
}

}  // namespace

double BiasSigma::curve_at(double temperature) const {
  const Eigen::ArrayXd& T = curve.temperatures;
  const double below = T(0) - temperature;
  const double above = temperature - T(T.size() - 1);
  return std::hypot(curve.at(temperature), growth[0] * std::max(below, 0.0),
                    growth[1] * std::max(above, 0.0));
}

double BiasSigma::at(double temperature, double since_power_on,
                     double temperature_rate_K_per_s) const {
  return factor *
         std::hypot(curve_at(temperature),
                    power_on ? power_on->amplitude * since_power_on : 0.0,
                    temperature_rate
                        ? temperature_rate->amplitude * temperature_rate_K_per_s
                        : 0.0);
}

std::vector<Input> BiasSigma::inputs() const {
  return {{InputKind::kColumn, "temperature", 0.0},
          {InputKind::kSincePowerOn, "", time_constant_of(power_on)},
          {InputKind::kTemperatureRate, "temperature",
           time_constant_of(temperature_rate)}};
}

BiasSigmaStream::BiasSigmaStream(BiasSigma sigma)
    : sigma_(std::move(sigma)),
      features_(sigma_.inputs(), kSigmaTemperatures) {}

double BiasSigmaStream::step(double time, std::uint8_t status,
                             double temperature) {
  const std::array<double, 3> measured = {temperature, 0.0, temperature};
  std::array<double, 3> x{};
  if (!features_.step(time, status, measured, x))
    return std::numeric_limits<double>::quiet_NaN();
  return sigma_.at(x[0], x[1], x[2]);
}

std::vector<double> sigma_of(const BiasSigma& sigma,
                             const Recording& recording) {
  const Eigen::ArrayXXd x =
      features_of(sigma.inputs(), recording, kSigmaTemperatures);
  std::vector<double> result(recording.time.size(),
                             std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < result.size(); ++k)
    if ((recording.status[k] & kUnpowered) == 0) {
      const auto row = static_cast<Eigen::Index>(k);
      result[k] = sigma.at(x(row, 0), x(row, 1), x(row, 2));
    }
  return result;
}

BiasStep bias_step(double before, double after, double temperature_change,
                   double correlation) {
  const double distance = std::abs(temperature_change) / correlation;
  return {std::exp(-distance) * after / before,
          -std::expm1(-2.0 * distance) * after * after};
}

double bias_walk_per_kelvin(double sigma, double correlation) {
  return 2.0 * sigma * sigma / correlation;
}

void put_sigma_terms(const std::optional<SigmaTerm>& power_on,
                     const std::optional<SigmaTerm>& temperature_rate,
                     Json& json) {
  if (power_on) json["power_on"] = term_json(*power_on, kPowerOnAmplitude);
  if (temperature_rate)
    json["temperature_rate"] = term_json(*temperature_rate, kRateAmplitude);
}

double read_half_width(const JsonNode& node) {
  if (!node.has("half_width")) return 0.0;
  const double half_width = node.at("half_width").number();
  if (!(half_width >= 0.0))
    node.at("half_width")
        .fail(fmt::format("{}, must not be below 0", half_width));
  return half_width;
}

std::optional<SigmaTerm> read_power_on_sigma(const JsonNode& node) {
  return read_term(node, "power_on", kPowerOnAmplitude);
}

std::optional<SigmaTerm> read_temperature_rate_sigma(const JsonNode& node) {
  return read_term(node, "temperature_rate", kRateAmplitude);
}

Json bias_sigma_json(const BiasSigma& sigma) {
  Json json = {{"temperature_degC", numbers_json(sigma.curve.temperatures)},
               {"sigma_deg_per_s", numbers_json(sigma.curve.values)},
               {"growth_deg_per_s_per_K", numbers_json(sigma.growth)}};
  put_sigma_terms(sigma.power_on, sigma.temperature_rate, json);
  json["factor"] = finite_json(sigma.factor);
  json["source"] = kSources[static_cast<std::size_t>(sigma.source)];
  json["calibration"] = {
      {"method", sigma.calibration.method},
      {"by", sigma.calibration.by},
      {"groups", sigma.calibration.groups},
      {"level", finite_json(sigma.calibration.level)},
      {"half_width", finite_json(sigma.calibration.half_width)}};
  if (const Json holds_for = sigma_validity_json(sigma.validity);
      !holds_for.is_null())
    json["holds_for"] = holds_for;
  return json;
}

BiasSigma read_bias_sigma(const JsonNode& node) {
  node.require_only({"temperature_degC", "sigma_deg_per_s",
                     "growth_deg_per_s_per_K", "power_on", "temperature_rate",
                     "factor", "source", "calibration", "holds_for"});
  BiasSigma sigma;
  sigma.curve = read_curve(node);
  const std::vector<JsonNode> growth =
      node.at("growth_deg_per_s_per_K").elements();
  if (growth.size() != 2)
    node.at("growth_deg_per_s_per_K")
        .fail(fmt::format("{} values, must be [below, above]", growth.size()));
  sigma.growth = {read_positive(growth[0]), read_positive(growth[1])};
  sigma.power_on = read_power_on_sigma(node);
  sigma.temperature_rate = read_temperature_rate_sigma(node);
  sigma.factor = read_sized(node.at("factor"));
  sigma.source = read_source(node.at("source"));
  sigma.calibration = read_calibration(node.at("calibration"));
  if (node.has("holds_for"))
    sigma.validity = read_sigma_validity(node.at("holds_for"));
  return sigma;
}

}  // namespace beamgyro::internal
