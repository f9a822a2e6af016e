// SPDX-License-Identifier: MIT
#include "compensation/compensator/compensator_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/compensator/training_runs_json.h"
#include "compensation/methods/bias_model.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/models/parameter_json.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "dataset/files/json_node.h"
#include "dataset/files/text_file.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

Json scale_json(const Scale& scale) {
  return {{"centre", finite_json(scale.centre)},
          {"half_width", finite_json(scale.half_width)}};
}

Scale read_scale(const JsonNode& node) {
  const Scale scale{node.at("centre").number(), node.at("half_width").number()};
  if (!(scale.half_width > 0.0))
    node.at("half_width")
        .fail(fmt::format("{}, must be positive", scale.half_width));
  return scale;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for_each_alternative<BiasFunction>(
      [&]<class Function>() { names.push_back(Function::kKind); });
  return names;
}

BiasFunction read_function(const JsonNode& node, const JsonNode& parameters,
                           const std::string& kind, std::size_t inputs) {
  BiasFunction function;
  for_each_alternative<BiasFunction>([&]<class Function>() {
    if (kind != Function::kKind) return;
    if (Function::kInputUse == InputUse::kOne && inputs != 1)
      node.at("input_scales")
          .fail(fmt::format("{} inputs, a {} takes one", inputs, kind));
    function = Function::read(parameters, inputs);
  });
  return function;
}

// Adds the keys of a model, without its kind.
void put_bias_model(const BiasModel& model, Json& json) {
  json["input_scales"] = Json::array();
  for (const Scale& scale : model.input_scales)
    json["input_scales"].push_back(scale_json(scale));
  json["bias_scale"] = scale_json(model.bias_scale);
  json["parameters"] =
      std::visit([](const auto& f) { return f.parameters(); }, model.function);
}

std::string read_bias_kind(const JsonNode& node) {
  const std::string kind = node.text();
  const std::vector<std::string> known = kind_names();
  if (std::ranges::find(known, kind) == known.end())
    node.fail(
        fmt::format("\"{}\", must be one of {}", kind, fmt::join(known, ", ")));
  return kind;
}

// What put_bias_model() wrote for a model of that kind.
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
  model.function = read_function(node, node.at("parameters"), kind, inputs);
  return model;
}

constexpr const char* kFiletype = "beamgyro-compensator";
constexpr long kFormatVersion = 2;

Json json_of(const std::optional<double>& value) {
  return value ? finite_json(*value) : Json();
}

Json json_of(const std::optional<CrossValidated>& cv) {
  if (!cv) return {};
  return {
      {"by", cv->by},
      {"groups", cv->groups},
      {"rms_deg_per_s", finite_json(cv->rms)},
      {"standard_error_deg_per_s", finite_json(cv->standard_error)},
      {"constant_rms_deg_per_s", finite_json(cv->constant_rms)},
      {"group_rms_deg_per_s", numbers_json(cv->group_rms)},
      {"constant_group_rms_deg_per_s", numbers_json(cv->constant_group_rms)}};
}

Json json_of(const Provenance& p) {
  Json json{{"method", p.method}};
  put_training_runs(p, json);
  if (!p.device_sha256.empty()) json["device_sha256"] = p.device_sha256;
  json.update(Json{
      {"model", p.model_text},
      {"seed", p.seed},
      {"stop_reason", p.stop_reason},
      {"in_sample_rms_deg_per_s", finite_json(p.in_sample_rms)},
      {"held_out_rms_deg_per_s", json_of(p.held_out_rms)},
      {"baseline_in_sample_rms_deg_per_s",
       finite_json(p.baseline_in_sample_rms)},
      {"baseline_held_out_rms_deg_per_s", json_of(p.baseline_held_out_rms)},
      {"straight_lines_in_sample_rms_deg_per_s",
       json_of(p.lines_in_sample_rms)},
      {"straight_lines_held_out_rms_deg_per_s", json_of(p.lines_held_out_rms)},
      {"constant_bias_deg_per_s", json_of(p.constant_bias)},
      {"constant_in_sample_rms_deg_per_s",
       finite_json(p.constant_in_sample_rms)},
      {"constant_held_out_rms_deg_per_s", json_of(p.constant_held_out_rms)},
      {"cross_validation", json_of(p.cross_validated)},
      {"choices", p.choices},
      {"warnings", p.warnings}});
  return json;
}

std::optional<CrossValidated> read_cross_validation(const JsonNode& node) {
  if (node.is_null()) return std::nullopt;
  const auto numbers = [&](const char* key) {
    return node.has(key) ? node.at(key).numbers() : std::vector<double>{};
  };
  return CrossValidated{
      node.at("by").text(),
      static_cast<std::size_t>(node.at("groups").integer(1, 1000000000)),
      node.at("rms_deg_per_s").number(),
      node.at("standard_error_deg_per_s").number(),
      node.at("constant_rms_deg_per_s").number(),
      numbers("group_rms_deg_per_s"),
      numbers("constant_group_rms_deg_per_s")};
}

Provenance read_provenance(const JsonNode& node) {
  Provenance p;
  p.method = node.at("method").text();
  read_training_runs(node, p);
  if (node.has("device_sha256"))
    p.device_sha256 = node.at("device_sha256").text();
  p.model_text = node.at("model").text();
  p.seed = node.at("seed").unsigned_integer();
  p.stop_reason = node.at("stop_reason").text();
  p.in_sample_rms = node.at("in_sample_rms_deg_per_s").number();
  p.held_out_rms = node.at("held_out_rms_deg_per_s").optional_number();
  p.baseline_in_sample_rms =
      node.at("baseline_in_sample_rms_deg_per_s").number();
  p.baseline_held_out_rms =
      node.at("baseline_held_out_rms_deg_per_s").optional_number();
  // Not in older files.
  if (node.has("straight_lines_in_sample_rms_deg_per_s"))
    p.lines_in_sample_rms =
        node.at("straight_lines_in_sample_rms_deg_per_s").optional_number();
  if (node.has("straight_lines_held_out_rms_deg_per_s"))
    p.lines_held_out_rms =
        node.at("straight_lines_held_out_rms_deg_per_s").optional_number();
  if (node.has("constant_bias_deg_per_s"))
    p.constant_bias = node.at("constant_bias_deg_per_s").optional_number();
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

// It must grow outside the temperatures of training.
BiasSigma read_sigma(const JsonNode& node, const TemperatureRange& range) {
  constexpr double kSlack = 1e-6;  // [K]
  BiasSigma sigma = read_bias_sigma(node);
  const Eigen::ArrayXd& T = sigma.curve.temperatures;
  if (!(T(0) >= range.lowest - kSlack &&
        T(T.size() - 1) <= range.highest + kSlack))
    node.at("temperature_degC")
        .fail(fmt::format("{} to {} degC, must lie within temperature_range_"
                          "degC, {} to {}",
                          T(0), T(T.size() - 1), range.lowest, range.highest));
  return sigma;
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

FittedCompensator read_root(const JsonNode& root) {
  check_header(root);
  const std::string kind = read_bias_kind(root.at("kind"));
  FittedCompensator c;
  c.inputs = read_inputs(root.at("inputs"));
  if (c.inputs.empty()) root.at("inputs").fail("[], must name an input");
  c.bias = read_bias_model(root, kind, c.inputs.size());
  if (root.has("scale_factor")) {
    const JsonNode node = root.at("scale_factor");
    c.scale_factor = read_lookup_table(node, "values");
    if (!(c.scale_factor->values > 0.0).all())
      node.at("values").fail("must be above 0");
  }
  c.temperature_range = read_range(root.at("temperature_range_degC"));
  c.baseline = read_bias_model(root.at("baseline"), "polynomial", 1);
  if (root.has("straight_lines"))
    c.straight_lines = LookupTable::read(root.at("straight_lines"), 1);
  if (root.has("population"))
    c.population = read_population(root.at("population"));
  if (root.has("sigma"))
    c.sigma = read_sigma(root.at("sigma"), c.temperature_range);
  if (root.has("sigma_not_known")) {
    const JsonNode why = root.at("sigma_not_known");
    if (c.sigma) why.fail("is there beside a sigma; expected one of the two");
    c.sigma_not_known = why.text();
  }
  c.provenance = read_provenance(root.at("training"));
  return c;
}

}  // namespace

std::string compensator_text(const FittedCompensator& compensator) {
  const FittedCompensator& c = compensator;
  Json json;
  json["filetype"] = kFiletype;
  json["format_version"] = kFormatVersion;
  json["kind"] = kind_name(c.bias);
  json["inputs"] = input_names(c.inputs);
  put_bias_model(c.bias, json);
  if (c.scale_factor)
    json["scale_factor"] = {
        {"temperatures_degC", numbers_json(c.scale_factor->temperatures)},
        {"values", numbers_json(c.scale_factor->values)}};
  json["temperature_range_degC"] = {finite_json(c.temperature_range.lowest),
                                    finite_json(c.temperature_range.highest)};
  json["baseline"]["kind"] = kind_name(c.baseline);
  put_bias_model(c.baseline, json["baseline"]);
  if (c.straight_lines) json["straight_lines"] = c.straight_lines->parameters();
  if (c.population) json["population"] = population_json(*c.population);
  if (c.sigma) json["sigma"] = bias_sigma_json(*c.sigma);
  if (!c.sigma_not_known.empty()) json["sigma_not_known"] = c.sigma_not_known;
  json["training"] = json_of(c.provenance);
  // A file name need not be UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

FittedCompensator parse_compensator(const std::string& text,
                                    const std::string& name) {
  const Json json = parse_json(text, name);
  return read_root(JsonNode(json, name));
}

std::string read_compensator_text(const std::filesystem::path& file) {
  return read_json_text(file, "a compensator");
}

FittedCompensator read_compensator(const std::filesystem::path& file) {
  return parse_compensator(read_compensator_text(file), file.string());
}

}  // namespace beamgyro::internal
