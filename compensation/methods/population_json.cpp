// SPDX-License-Identifier: MIT
// A population as a member of compensator files.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compensation/methods/method_inputs.h"
#include "compensation/methods/population.h"
#include "compensation/models/array_view.h"
#include "compensation/models/parameter_json.h"
#include "compensation/uncertainty/bias_sigma.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;

Json adaptation_json(const AdaptationSigma& sigma) {
  Json json = {{"factor", finite_json(sigma.factor)},
               {"devices", sigma.devices},
               {"half_width", finite_json(sigma.half_width)}};
  put_sigma_terms(sigma.power_on, sigma.temperature_rate, json);
  return json;
}

AdaptationSigma read_adaptation(const JsonNode& node) {
  node.require_only(
      {"factor", "devices", "half_width", "power_on", "temperature_rate"});
  return {read_positive(node.at("factor")), read_power_on_sigma(node),
          read_temperature_rate_sigma(node),
          static_cast<int>(node.at("devices").integer(1, 2147483647)),
          read_half_width(node)};
}

// Own parts: one for each curve, or none. Files of older programs have none.
Json own_json(const std::vector<OwnPart>& own) {
  Json json = Json::array();
  for (const OwnPart& part : own)
    json.push_back({{"deviation", finite_json(part.deviation)},
                    {"length_K", finite_json(part.length_K)}});
  return json;
}

std::vector<OwnPart> read_own(const JsonNode& node, std::size_t curves) {
  std::vector<OwnPart> own;
  for (const JsonNode& part : node.elements()) {
    part.require_only({"deviation", "length_K"});
    own.push_back(
        {part.at("deviation").number(), read_positive(part.at("length_K"))});
    if (own.back().deviation < 0.0)
      part.at("deviation")
          .fail(
              fmt::format("{:g}, must not be negative", own.back().deviation));
  }
  if (!own.empty() && own.size() != curves)
    node.fail(
        fmt::format("{} own parts, must be none or {}, one for each curve",
                    own.size(), curves));
  return own;
}

// The squares of c add up to the number of devices less one for each mode. Of
// some of the devices that is so within a few per cent.
void check_coefficients(const JsonNode& node, const Eigen::MatrixXd& c,
                        int devices) {
  if (c.rows() == 0) return;
  const Index expected = std::min<Index>(devices, kMostCoefficients);
  if (c.rows() != expected)
    node.fail(
        fmt::format("of {} devices, must be of {}: the population was "
                    "learned from {}",
                    c.rows(), expected, devices));
  if (c.cols() == 0) return;
  const double square =
      c.squaredNorm() / static_cast<double>(c.size()) * devices / (devices - 1);
  constexpr double kLargest = 2.0;  // and its inverse the smallest
  if (!(square < kLargest && square > 1.0 / kLargest))
    node.fail(fmt::format(
        "mean square {:.3g}, must be 1: each is over the deviation of its mode",
        square));
}

// c of the devices; files of older programs have none.
Eigen::MatrixXd read_coefficients(const JsonNode& node, Index modes,
                                  int count) {
  if (!node.has("coefficients")) return {};
  const Eigen::MatrixXd coefficients =
      read_matrix(node.at("coefficients"), modes, ", one for each mode");
  check_coefficients(node.at("coefficients"), coefficients, count);
  return coefficients;
}

Eigen::MatrixXd read_hysteresis(const JsonNode& node, Index devices,
                                Index grid) {
  Eigen::MatrixXd half = read_matrix(node, grid, ", one for each temperature");
  if (half.rows() != devices)
    node.fail(
        fmt::format("of {} devices, must be of the {} that have "
                    "coefficients",
                    half.rows(), devices));
  return half;
}

Sweeps read_sweeps(const JsonNode& node) {
  node.require_only({"of_each_device", "s_per_K"});
  return {read_positive(node.at("of_each_device")),
          read_positive(node.at("s_per_K"))};
}

}  // namespace

Json population_json(const Population& population) {
  Json json = {{"devices", population.devices},
               {"channels", input_names(population.channels)},
               {"temperatures_degC", numbers_json(population.temperatures)},
               {"mean", numbers_json(population.mean)},
               {"modes", rows_json(population.modes.transpose())},
               {"own", own_json(population.own)},
               {"point_noise_deg_per_s", finite_json(population.point_noise)},
               {"run_noise_deg_per_s", finite_json(population.run_noise)},
               {"coefficients", rows_json(population.coefficients)}};
  if (population.hysteresis.size() > 0)
    json["hysteresis"] = rows_json(population.hysteresis);
  if (population.sweeps)
    json["sweeps"] = {
        {"of_each_device", finite_json(population.sweeps->of_each_device)},
        {"s_per_K", finite_json(population.sweeps->seconds_per_K)}};
  if (population.sigma) json["sigma"] = adaptation_json(*population.sigma);
  return json;
}

Population read_population(const JsonNode& node) {
  Population population;
  population.devices =
      static_cast<int>(node.at("devices").integer(2, 2147483647));
  population.channels = read_inputs(node.at("channels"));
  const std::vector<double> T = node.at("temperatures_degC").numbers();
  const auto grid = static_cast<Index>(T.size());
  population.temperatures = array_view(T);
  const Eigen::ArrayXd& grid_T = population.temperatures;
  if (grid < 4 || !(grid_T.tail(grid - 1) > grid_T.head(grid - 1)).all())
    node.at("temperatures_degC").fail("must be 4 or more that increase");
  const Index size =
      grid * (1 + static_cast<Index>(population.channels.size()));
  constexpr const char* kEach = ", one for each curve and temperature";
  population.mean = read_array(node.at("mean"), size, kEach).matrix();
  population.modes = read_matrix(node.at("modes"), size, kEach).transpose();
  population.coefficients =
      read_coefficients(node, population.modes.cols(), population.devices);
  if (node.has("hysteresis"))
    population.hysteresis = read_hysteresis(
        node.at("hysteresis"), population.coefficients.rows(), grid);
  if (node.has("own"))
    population.own = read_own(node.at("own"), 1 + population.channels.size());
  if (node.has("point_noise_deg_per_s"))
    population.point_noise = read_positive(node.at("point_noise_deg_per_s"));
  population.run_noise = node.has("run_noise_deg_per_s")
                             ? read_positive(node.at("run_noise_deg_per_s"))
                             : population.point_noise;
  if (node.has("sweeps")) population.sweeps = read_sweeps(node.at("sweeps"));
  if (node.has("sigma")) population.sigma = read_adaptation(node.at("sigma"));
  return population;
}

}  // namespace beamgyro::internal
