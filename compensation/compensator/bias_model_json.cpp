// SPDX-License-Identifier: MIT
#include "compensation/compensator/bias_model_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace beamgyro {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKindNames[] = {"none",  "constant", "polynomial",
                                      "table", "spline",   "thermistor",
                                      "fuzzy", "bp"};

Json scale_json(const Scale& scale) {
  return {{"centre", finite_json(scale.centre)},
          {"half_width", finite_json(scale.half_width)}};
}

struct Parameters {
  Json operator()(const NoBias&) const { return Json::object(); }
  Json operator()(const ConstantBias& constant) const {
    return {{"value_deg_per_s", finite_json(constant.value)}};
  }
  Json operator()(const Polynomial& polynomial) const {
    return {{"coefficients", numbers_json(polynomial.coefficients)},
            {"slopes", numbers_json(polynomial.slopes)}};
  }
  Json operator()(const LookupTable& table) const {
    return {{"temperatures_degC", numbers_json(table.temperatures)},
            {"values_deg_per_s", numbers_json(table.values)}};
  }
  Json operator()(const ThermistorNetwork& network) const {
    return {{"b_K", finite_json(network.b_K)},
            {"series", finite_json(network.series)},
            {"parallel", finite_json(network.parallel)},
            {"divider", finite_json(network.divider)},
            {"offset_deg_per_s", finite_json(network.offset)},
            {"gain_deg_per_s", finite_json(network.gain)}};
  }
  Json operator()(const TakagiSugeno& fuzzy) const {
    Json consequents = Json::array();
    for (const auto& rule : fuzzy.consequents.rowwise())
      consequents.push_back(numbers_json(rule));
    return {{"centres", numbers_json(fuzzy.centres)},
            {"width", finite_json(fuzzy.width)},
            {"consequents", consequents}};
  }
  Json operator()(const CubicSpline& spline) const {
    return {{"knots_degC", numbers_json(spline.knots)},
            {"values_deg_per_s", numbers_json(spline.values)},
            {"second_derivatives_deg_per_s_per_K2",
             numbers_json(spline.second_derivatives)}};
  }
  Json operator()(const BpNetwork& network) const {
    return {{"layer_sizes", network.layer_sizes()},
            {"weights", numbers_json(network.weights())}};
  }
};

Scale read_scale(const JsonNode& node) {
  const Scale scale{node.at("centre").number(), node.at("half_width").number()};
  if (!(scale.half_width > 0.0))
    node.at("half_width")
        .fail(fmt::format("{}, must be positive", scale.half_width));
  return scale;
}

Eigen::ArrayXd read_array(const JsonNode& node) {
  const std::vector<double> numbers = node.numbers();
  return Eigen::Map<const Eigen::ArrayXd>(
      numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

Polynomial read_polynomial(const JsonNode& node, std::size_t inputs) {
  Polynomial polynomial{node.at("coefficients").numbers(),
                        node.at("slopes").numbers()};
  if (polynomial.coefficients.empty())
    node.at("coefficients").fail("[], must have at least one coefficient");
  if (polynomial.slopes.size() + 1 != inputs)
    node.at("slopes").fail(
        fmt::format("{} slopes, must be one for each of the {} inputs but the "
                    "first",
                    polynomial.slopes.size(), inputs));
  return polynomial;
}

double read_positive(const JsonNode& node) {
  const double number = node.number();
  if (!(number > 0.0)) node.fail(fmt::format("{}, must be above 0", number));
  return number;
}

ThermistorNetwork read_thermistor(const JsonNode& node) {
  return {
      read_positive(node.at("b_K")),        read_positive(node.at("series")),
      read_positive(node.at("parallel")),   read_positive(node.at("divider")),
      node.at("offset_deg_per_s").number(), node.at("gain_deg_per_s").number()};
}

TakagiSugeno read_fuzzy(const JsonNode& node, std::size_t inputs) {
  TakagiSugeno fuzzy{
      read_array(node.at("centres")), read_positive(node.at("width")), {}};
  const std::vector<JsonNode> rules = node.at("consequents").elements();
  const auto width = static_cast<Eigen::Index>(inputs) + 1;
  if (rules.empty() ||
      fuzzy.centres.size() != static_cast<Eigen::Index>(rules.size()))
    node.at("consequents")
        .fail(fmt::format("{} rules, must be one for each of the {} centres",
                          rules.size(), fuzzy.centres.size()));
  fuzzy.consequents.resize(fuzzy.centres.size(), width);
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const Eigen::ArrayXd rule = read_array(rules[i]);
    if (rule.size() != width)
      rules[i].fail(fmt::format("{} numbers, must be {}", rule.size(), width));
    fuzzy.consequents.row(static_cast<Eigen::Index>(i)) = rule.matrix();
  }
  return fuzzy;
}

CubicSpline read_spline(const JsonNode& node) {
  CubicSpline spline{
      read_array(node.at("knots_degC")),
      read_array(node.at("values_deg_per_s")),
      read_array(node.at("second_derivatives_deg_per_s_per_K2"))};
  const Eigen::Index n = spline.knots.size();
  if (n < 4 || spline.values.size() != n ||
      spline.second_derivatives.size() != n)
    node.fail(
        fmt::format("{} knots, {} values and {} second derivatives, must "
                    "be as many of each and at least 4",
                    n, spline.values.size(), spline.second_derivatives.size()));
  if (!(spline.knots.tail(n - 1) > spline.knots.head(n - 1)).all())
    node.at("knots_degC").fail("must increase");
  return spline;
}

BpNetwork read_network(const JsonNode& node, std::size_t inputs) {
  std::vector<int> sizes;
  for (const JsonNode& size : node.at("layer_sizes").elements())
    sizes.push_back(static_cast<int>(size.integer(1, 1000)));
  if (sizes.size() < 2 || sizes.size() > 10 || sizes.back() != 1 ||
      sizes.front() != static_cast<int>(inputs))
    node.at("layer_sizes")
        .fail(fmt::format("must start with the {} inputs and end with 1 output",
                          inputs));
  BpNetwork network(sizes);
  const JsonNode weights = node.at("weights");
  try {
    network.set_weights(read_array(weights).matrix());
  } catch (const std::invalid_argument& error) {
    weights.fail(error.what());
  }
  return network;
}

}  // namespace

void put_bias_model(const BiasModel& model, Json& json) {
  json["input_scales"] = Json::array();
  for (const Scale& scale : model.input_scales)
    json["input_scales"].push_back(scale_json(scale));
  json["bias_scale"] = scale_json(model.bias_scale);
  json["parameters"] = std::visit(Parameters{}, model.function);
}

LookupTable read_lookup_table(const JsonNode& node, const std::string& values) {
  LookupTable table{read_array(node.at("temperatures_degC")),
                    read_array(node.at(values))};
  const Eigen::Index n = table.temperatures.size();
  if (n < 1 || table.values.size() != n)
    node.at(values).fail(
        fmt::format("{} values for {} temperatures, must be as many and at "
                    "least 1",
                    table.values.size(), n));
  if (!(table.temperatures.tail(n - 1) > table.temperatures.head(n - 1)).all())
    node.at("temperatures_degC").fail("must increase");
  return table;
}

std::string read_bias_kind(const JsonNode& node) {
  const std::string kind = node.text();
  if (std::find(std::begin(kKindNames), std::end(kKindNames), kind) ==
      std::end(kKindNames))
    node.fail(fmt::format("\"{}\", must be one of {}", kind,
                          fmt::join(kKindNames, ", ")));
  return kind;
}

BiasModel read_bias_model(const JsonNode& node, const std::string& kind,
                          std::size_t inputs) {
  BiasModel model;
  for (const JsonNode& scale : node.at("input_scales").elements())
    model.input_scales.push_back(read_scale(scale));
  if (model.input_scales.size() != inputs)
    node.at("input_scales")
        .fail(fmt::format("{} scales, must be one for each of the {} inputs",
                          model.input_scales.size(), inputs));
  model.bias_scale = read_scale(node.at("bias_scale"));
  const JsonNode parameters = node.at("parameters");
  const bool one_input =
      kind == "table" || kind == "spline" || kind == "thermistor";
  if (one_input && inputs != 1)
    node.at("input_scales")
        .fail(fmt::format("{} inputs, a {} takes one", inputs, kind));
  if (kind == "none") model.function = NoBias{};
  if (kind == "constant")
    model.function = ConstantBias{parameters.at("value_deg_per_s").number()};
  if (kind == "polynomial")
    model.function = read_polynomial(parameters, inputs);
  if (kind == "table")
    model.function = read_lookup_table(parameters, "values_deg_per_s");
  if (kind == "spline") model.function = read_spline(parameters);
  if (kind == "thermistor") model.function = read_thermistor(parameters);
  if (kind == "fuzzy") model.function = read_fuzzy(parameters, inputs);
  if (kind == "bp") model.function = read_network(parameters, inputs);
  return model;
}

}  // namespace beamgyro
