// SPDX-License-Identifier: MIT
#include "sim/campaign/spurious_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace beamgyro::internal {
namespace {

using ModeNumbers = std::array<double, kSpuriousNumbers>;

ConfigNode with_key(ConfigNode node, std::string_view key) {
  node.key = key;
  return node;
}

ConfigNode text_node(std::string_view text) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kText;
  node.text = text;
  return node;
}

ConfigNode mode_table(const SpuriousPopulation& population,
                      const ModeNumbers& mode) {
  const double product =
      population.product_per_height * mode[kLossFactor] * mode[kHeight];
  const double ratio = mode[kCouplingRatio];
  const double e_x = std::sqrt(std::abs(product) * ratio);
  const double e_y =
      std::copysign(std::sqrt(std::abs(product) / ratio), product);
  ConfigNode table;
  const auto add = [&](std::string_view key, double value) {
    table.children.push_back(with_key(number_node(value), key));
  };
  add("detuning", mode[kDetuning]);
  add("detuning_tc_per_K", mode[kDetuningTc]);
  add("loss_factor", mode[kLossFactor]);
  add("coupling_drive", e_x);
  add("coupling_sense", e_y);
  if (population.follow_housing)
    table.children.push_back(with_key(text_node("housing"), "follows"));
  return table;
}

}  // namespace

int SpuriousPopulation::most() const {
  return *std::ranges::max_element(counts);
}

std::size_t SpuriousPopulation::numbers() const {
  return 1 + std::size_t{kSpuriousNumbers} * static_cast<std::size_t>(most());
}

ConfigNode drawn_modes(const SpuriousPopulation& population,
                       const double* uniform, std::vector<double>& parameters) {
  const int count = population.counts[static_cast<std::size_t>(
      quantile(population.count, *uniform++))];
  parameters.push_back(count);
  ConfigNode modes;
  for (int i = 0; i < population.most(); ++i) {
    ModeNumbers mode{};
    for (std::size_t k = 0; k < mode.size(); ++k) {
      mode[k] = quantile(population.of_mode[k], *uniform++);
      parameters.push_back(mode[k]);
    }
    if (i < count)
      modes.children.push_back(with_key(mode_table(population, mode),
                                        fmt::format("mode_{}", i + 1)));
  }
  return modes;
}

}  // namespace beamgyro::internal
