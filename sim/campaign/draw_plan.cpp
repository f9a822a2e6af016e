// SPDX-License-Identifier: MIT
#include "sim/campaign/draw_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace beamgyro::internal {
namespace {

ConfigNode drawn_element(const Draw& draw, double uniform,
                         std::vector<double>& parameters) {
  const double value = quantile(draw.distribution, uniform);
  if (draw.distribution.kind != Distribution::Kind::kDiscrete) {
    parameters.push_back(value);
    return number_node(value);
  }
  const ConfigNode& choice = draw.values[static_cast<std::size_t>(value)];
  if (!draw.numeric) {
    parameters.push_back(value);
  } else {
    const bool whole = choice.kind == ConfigNode::Kind::kInteger;
    parameters.push_back(whole ? static_cast<double>(choice.integer)
                               : choice.number);
  }
  return choice;
}

}  // namespace

std::string key_of(const Draw& draw) {
  return fmt::format("{}", fmt::join(draw.path, "."));
}

ConfigNode drawn_value(const Draw& draw, const double* uniform,
                       std::vector<double>& parameters) {
  if (draw.elements == 0) return drawn_element(draw, *uniform, parameters);
  ConfigNode array;
  array.kind = ConfigNode::Kind::kArray;
  for (std::size_t i = 0; i < draw.elements; ++i)
    array.children.push_back(drawn_element(draw, uniform[i], parameters));
  return array;
}

DrawnValues drawn_values(const DrawPlan& plan, const UniformSource& source,
                         std::uint32_t device) {
  std::vector<double> uniform(plan.parameters.size());
  for (std::size_t i = 0; i < uniform.size(); ++i) {
    uniform[i] =
        source.number(device, plan.streams[i], plan.first_dimension + i);
  }
  return drawn_values(plan, std::move(uniform));
}

DrawnValues drawn_values(const DrawPlan& plan, std::vector<double> uniform) {
  for (const CorrelatedGroup& group : plan.groups) correlate(group, uniform);
  DrawnValues drawn;
  drawn.parameters.reserve(uniform.size());
  drawn.values.reserve(plan.draws.size());
  const double* next = uniform.data();
  for (const Draw& draw : plan.draws) {
    drawn.values.push_back(drawn_value(draw, next, drawn.parameters));
    next += draw.numbers();
  }
  return drawn;
}

Overrides overrides_of(const DrawPlan& plan,
                       const std::vector<ConfigNode>& values) {
  Overrides overrides;
  for (std::size_t i = 0; i < values.size(); ++i)
    overrides.add(plan.draws[i].path, values[i]);
  return overrides;
}

}  // namespace beamgyro::internal
