// SPDX-License-Identifier: MIT
#include "compensation/compensator_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "compensation/json_node.h"
#include "dataset/atomic_file.h"
#include "dataset/text_file.h"

namespace beamgyro {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFiletype = "beamgyro-compensator";
constexpr long kFormatVersion = 2;
constexpr const char* kKindNames[] = {"none",  "constant", "polynomial",
                                      "table", "spline",   "thermistor",
                                      "fuzzy", "bp"};

Json to_json(double value) {
  if (!std::isfinite(value))
    throw std::runtime_error(fmt::format(
        "the compensator has a parameter that is {}; not written", value));
  return value;
}

Json to_json(const std::optional<double>& value) {
  return value ? to_json(*value) : Json();
}

template <class Numbers>
Json array_of(const Numbers& numbers) {
  Json array = Json::array();
  for (const double number : numbers) array.push_back(to_json(number));
  return array;
}

Json to_json(const Scale& scale) {
  return {{"centre", to_json(scale.centre)},
          {"half_width", to_json(scale.half_width)}};
}

struct Parameters {
  Json operator()(const NoBias&) const { return Json::object(); }
  Json operator()(const ConstantBias& constant) const {
    return {{"value_deg_per_s", to_json(constant.value)}};
  }
  Json operator()(const Polynomial& polynomial) const {
    return {{"coefficients", array_of(polynomial.coefficients)},
            {"slopes", array_of(polynomial.slopes)}};
  }
  Json operator()(const LookupTable& table) const {
    return {{"temperatures_degC", array_of(table.temperatures)},
            {"values_deg_per_s", array_of(table.values)}};
  }
  Json operator()(const ThermistorNetwork& network) const {
    return {{"b_K", to_json(network.b_K)},
            {"series", to_json(network.series)},
            {"parallel", to_json(network.parallel)},
            {"divider", to_json(network.divider)},
            {"offset_deg_per_s", to_json(network.offset)},
            {"gain_deg_per_s", to_json(network.gain)}};
  }
  Json operator()(const TakagiSugeno& fuzzy) const {
    Json consequents = Json::array();
    for (const auto& rule : fuzzy.consequents.rowwise())
      consequents.push_back(array_of(rule));
    return {{"centres", array_of(fuzzy.centres)},
            {"width", to_json(fuzzy.width)},
            {"consequents", consequents}};
  }
  Json operator()(const CubicSpline& spline) const {
    return {{"knots_degC", array_of(spline.knots)},
            {"values_deg_per_s", array_of(spline.values)},
            {"second_derivatives_deg_per_s_per_K2",
             array_of(spline.second_derivatives)}};
  }
  Json operator()(const BpNetwork& network) const {
    return {{"layer_sizes", network.layer_sizes()},
            {"weights", array_of(network.weights())}};
  }
};

void put_model(const BiasModel& model, Json& json) {
  json["input_scales"] = Json::array();
  for (const Scale& scale : model.input_scales)
    json["input_scales"].push_back(to_json(scale));
  json["bias_scale"] = to_json(model.bias_scale);
  json["parameters"] = std::visit(Parameters{}, model.function);
}

Json to_json(const std::vector<SourceFile>& files) {
  Json array = Json::array();
  for (const SourceFile& file : files)
    array.push_back({{"name", file.name}, {"sha256", file.sha256}});
  return array;
}

Json to_json(const std::optional<CrossValidated>& cv) {
  if (!cv) return {};
  return {{"by", cv->by},
          {"groups", cv->groups},
          {"rms_deg_per_s", to_json(cv->rms)},
          {"standard_error_deg_per_s", to_json(cv->standard_error)},
          {"constant_rms_deg_per_s", to_json(cv->constant_rms)}};
}

Json to_json(const Provenance& p) {
  return {
      {"method", p.method},
      {"files", to_json(p.training)},
      {"held_out_files", to_json(p.held_out)},
      {"model", p.model_text},
      {"seed", p.seed},
      {"stop_reason", p.stop_reason},
      {"in_sample_rms_deg_per_s", to_json(p.in_sample_rms)},
      {"held_out_rms_deg_per_s", to_json(p.held_out_rms)},
      {"baseline_in_sample_rms_deg_per_s", to_json(p.baseline_in_sample_rms)},
      {"baseline_held_out_rms_deg_per_s", to_json(p.baseline_held_out_rms)},
      {"constant_in_sample_rms_deg_per_s", to_json(p.constant_in_sample_rms)},
      {"constant_held_out_rms_deg_per_s", to_json(p.constant_held_out_rms)},
      {"cross_validation", to_json(p.cross_validated)},
      {"choices", p.choices},
      {"warnings", p.warnings}};
}

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

// Temperatures that increase, and as many values.
LookupTable read_table(const JsonNode& node, const std::string& values) {
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

BiasModel read_model(const JsonNode& node, const std::string& kind,
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
    model.function = read_table(parameters, "values_deg_per_s");
  if (kind == "spline") model.function = read_spline(parameters);
  if (kind == "thermistor") model.function = read_thermistor(parameters);
  if (kind == "fuzzy") model.function = read_fuzzy(parameters, inputs);
  if (kind == "bp") model.function = read_network(parameters, inputs);
  return model;
}

std::vector<SourceFile> read_files(const JsonNode& node) {
  std::vector<SourceFile> files;
  for (const JsonNode& file : node.elements())
    files.push_back({file.at("name").text(), file.at("sha256").text()});
  return files;
}

std::optional<CrossValidated> read_cross_validation(const JsonNode& node) {
  if (node.is_null()) return std::nullopt;
  return CrossValidated{
      node.at("by").text(),
      static_cast<std::size_t>(node.at("groups").integer(1, 1000000000)),
      node.at("rms_deg_per_s").number(),
      node.at("standard_error_deg_per_s").number(),
      node.at("constant_rms_deg_per_s").number()};
}

Provenance read_provenance(const JsonNode& node) {
  Provenance p;
  p.method = node.at("method").text();
  p.training = read_files(node.at("files"));
  p.held_out = read_files(node.at("held_out_files"));
  p.model_text = node.at("model").text();
  p.seed = node.at("seed").unsigned_integer();
  p.stop_reason = node.at("stop_reason").text();
  p.in_sample_rms = node.at("in_sample_rms_deg_per_s").number();
  p.held_out_rms = node.at("held_out_rms_deg_per_s").optional_number();
  p.baseline_in_sample_rms =
      node.at("baseline_in_sample_rms_deg_per_s").number();
  p.baseline_held_out_rms =
      node.at("baseline_held_out_rms_deg_per_s").optional_number();
  p.constant_in_sample_rms =
      node.at("constant_in_sample_rms_deg_per_s").number();
  p.constant_held_out_rms =
      node.at("constant_held_out_rms_deg_per_s").optional_number();
  p.cross_validated = read_cross_validation(node.at("cross_validation"));
  p.choices = node.at("choices").texts();
  p.warnings = node.at("warnings").texts();
  return p;
}

TemperatureRange read_range(const JsonNode& node) {
  const std::vector<double> ends = node.numbers();
  if (ends.size() != 2 || !(ends[0] <= ends[1]))
    node.fail("must be [lowest, highest]");
  return {ends[0], ends[1]};
}

void check_header(const JsonNode& root) {
  const JsonNode filetype = root.at("filetype");
  if (filetype.text() != kFiletype)
    filetype.fail(
        fmt::format("\"{}\", must be \"{}\"", filetype.text(), kFiletype));
  const JsonNode version = root.at("format_version");
  const long number = version.integer(1, 1000000);
  if (number < kFormatVersion)
    version.fail(
        fmt::format("{}, written by an older program; this one reads "
                    "version {}: train it anew",
                    number, kFormatVersion));
  if (number > kFormatVersion)
    version.fail(
        fmt::format("{}, written by a newer program; this one reads "
                    "version {}",
                    number, kFormatVersion));
}

Compensator read_root(const JsonNode& root) {
  check_header(root);
  const JsonNode kind = root.at("kind");
  if (std::find(std::begin(kKindNames), std::end(kKindNames), kind.text()) ==
      std::end(kKindNames))
    kind.fail(fmt::format("\"{}\", must be one of {}", kind.text(),
                          fmt::join(kKindNames, ", ")));
  Compensator c;
  for (const JsonNode& input : root.at("inputs").elements()) {
    const std::string text = input.text();
    try {
      c.inputs.push_back(parse_input(text));
    } catch (const std::invalid_argument& error) {
      input.fail(error.what());
    }
  }
  if (c.inputs.empty()) root.at("inputs").fail("[], must name an input");
  c.bias = read_model(root, kind.text(), c.inputs.size());
  if (root.has("scale_factor")) {
    const JsonNode node = root.at("scale_factor");
    c.scale_factor = read_table(node, "values");
    if (!(c.scale_factor->values > 0.0).all())
      node.at("values").fail("must be above 0");
  }
  c.temperature_range = read_range(root.at("temperature_range_degC"));
  c.baseline = read_model(root.at("baseline"), "polynomial", 1);
  c.provenance = read_provenance(root.at("training"));
  return c;
}

}  // namespace

std::string compensator_text(const Compensator& compensator) {
  const Compensator& c = compensator;
  Json json;
  json["filetype"] = kFiletype;
  json["format_version"] = kFormatVersion;
  json["kind"] = kind_name(c.bias);
  json["inputs"] = input_names(c.inputs);
  put_model(c.bias, json);
  if (c.scale_factor)
    json["scale_factor"] = {
        {"temperatures_degC", array_of(c.scale_factor->temperatures)},
        {"values", array_of(c.scale_factor->values)}};
  json["temperature_range_degC"] = {to_json(c.temperature_range.lowest),
                                    to_json(c.temperature_range.highest)};
  json["baseline"]["kind"] = kind_name(c.baseline);
  put_model(c.baseline, json["baseline"]);
  json["training"] = to_json(c.provenance);
  // A file name need not be UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Compensator parse_compensator(const std::string& text,
                              const std::string& name) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    const std::string what =
        error.what();  // "[json...] at line L, column C:.."
    throw std::invalid_argument(fmt::format("{}: not a whole JSON file: {}",
                                            name,
                                            what.substr(what.find("] ") + 2)));
  }
  return read_root(JsonNode(json, name));
}

void write_compensator(const Compensator& compensator,
                       const std::filesystem::path& file) {
  write_text_file(file, compensator_text(compensator));
}

Compensator read_compensator(const std::filesystem::path& file) {
  return parse_compensator(read_text_file(file), file.string());
}

}  // namespace beamgyro
