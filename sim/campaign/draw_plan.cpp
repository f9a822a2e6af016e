// SPDX-License-Identifier: MIT
#include "sim/campaign/draw_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "linear_algebra/cholesky.h"
#include "random/random_stream.h"

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

using Names = std::map<std::string_view, std::string_view>;

const Names kUnits = {
    {"deg", "degree"}, {"degC", "degC"},  {"rad", "rad"},    {"K", "K"},
    {"K2", "K2"},      {"m", "m"},        {"m2", "m2"},      {"m3", "m3"},
    {"s", "s"},        {"hours", "h"},    {"h", "h"},        {"min", "min"},
    {"Hz", "Hz"},      {"V", "V"},        {"F", "F"},        {"C", "C"},
    {"N", "N"},        {"Pa", "Pa"},      {"W", "W"},        {"J", "J"},
    {"kg", "kg"},      {"mol", "mol"},    {"g", "g"},        {"g2", "g2"},
    {"mK", "(m K)"},   {"m2K", "(m2 K)"}, {"kgK", "(kg K)"}, {"ppm", "1e-6"},
    {"year", "year"}};

// Takes the last part of the key: "K" of "tc_rad_per_K".
std::string_view take_last(std::string_view& key) {
  const std::size_t bar = key.rfind('_');
  const std::string_view last =
      key.substr(bar == std::string_view::npos ? 0 : bar + 1);
  key = key.substr(0, bar == std::string_view::npos ? 0 : bar);
  return last;
}

}  // namespace

Eigen::MatrixXd correlation_factor(const Eigen::MatrixXd& correlation) {
  if (correlation != correlation.transpose() ||
      (correlation.diagonal().array() != 1).any()) {
    throw std::invalid_argument(
        "not symmetric with ones on the diagonal; expected a correlation "
        "matrix");
  }
  const Cholesky factor(correlation);
  if (!factor.is_positive_definite() ||
      (factor.lower().diagonal().array() < 1e-6).any()) {
    throw std::invalid_argument(
        "not positive definite; no numbers are correlated so");
  }
  return factor.lower();
}

void correlate(const CorrelatedGroup& group, std::span<double> numbers) {
  Eigen::VectorXd z(group.factor.rows());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    z(i) = normal_quantile(numbers[group.members[static_cast<std::size_t>(i)]]);
  }
  const Eigen::VectorXd correlated = group.factor * z;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    numbers[group.members[static_cast<std::size_t>(i)]] =
        std::clamp(normal_cumulative(correlated(i)), 0x1p-53, 1 - 0x1p-53);
  }
}

std::uint32_t stream_number(std::string_view name) {
  constexpr std::uint32_t kPolynomial = 0xEDB88320;
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : name) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = crc >> 1 ^ ((crc & 1) != 0 ? kPolynomial : 0);
  }
  return ~crc;
}

double UniformSource::number(std::uint32_t device, std::uint32_t stream,
                             std::size_t dimension) const {
  if (sobol) return sobol->at(device, dimension);
  return RandomStream(seed, device, stream, kDeviceDrawStream).uniform();
}

std::string key_of(const Draw& draw) {
  return fmt::format("{}", fmt::join(draw.path, "."));
}

std::string number_key(const Draw& draw, std::size_t element) {
  if (!draw.modes)
    return draw.elements == 0 ? key_of(draw)
                              : fmt::format("{}[{}]", key_of(draw), element);
  if (element == 0) return "spurious_modes.count";
  const std::size_t k = element - 1;
  return fmt::format("spurious_modes.{}.{}", k / kSpuriousNumbers + 1,
                     kSpuriousNumberKeys[k % kSpuriousNumbers]);
}

ConfigNode drawn_value(const Draw& draw, const double* uniform,
                       std::vector<double>& parameters) {
  if (draw.modes) return drawn_modes(*draw.modes, uniform, parameters);
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

std::string units_of(std::string_view key) {
  if (const std::size_t dot = key.rfind('.'); dot != key.npos)
    key.remove_prefix(dot + 1);
  std::string units;  // from the back: "/s" and so on
  bool divided = true;
  while (divided) {
    const auto unit = kUnits.find(take_last(key));
    if (unit == kUnits.end()) return units.empty() ? "1" : '1' + units;
    std::string name(unit->second);
    std::string_view rest = key;
    std::string_view word = take_last(rest);
    if (word == "sqrt") {
      name = fmt::format("sqrt({})", name);
      key = rest;
      word = take_last(rest);
    }
    divided = word == "per";
    units = fmt::format("{}{}{}", divided ? "/" : "", name, units);
    if (divided) key = rest;
  }
  return units;
}

}  // namespace beamgyro::internal
