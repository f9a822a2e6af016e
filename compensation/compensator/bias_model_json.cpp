// SPDX-License-Identifier: MIT
#include "compensation/compensator/bias_model_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

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

}  // namespace

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

}  // namespace beamgyro::internal
