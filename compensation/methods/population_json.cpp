// SPDX-License-Identifier: MIT
#include "compensation/methods/population_json.h"

#include <fmt/format.h>

#include <stdexcept>

#include "compensation/models/array_view.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;
using Eigen::VectorXd;

VectorXd read_vector(const JsonNode& node, Index size) {
  const std::vector<double> numbers = node.numbers();
  if (static_cast<Index>(numbers.size()) != size)
    node.fail(
        fmt::format("{} numbers, must be {}, one for each curve and "
                    "temperature",
                    numbers.size(), size));
  return array_view(numbers);
}

}  // namespace

Json population_json(const Population& population) {
  Json modes = Json::array();
  for (const auto& mode : population.modes.colwise())
    modes.push_back(numbers_json(mode));
  return {{"devices", population.devices},
          {"channels", input_names(population.channels)},
          {"temperatures_degC", numbers_json(population.temperatures)},
          {"mean", numbers_json(population.mean)},
          {"modes", std::move(modes)}};
}

Population read_population(const JsonNode& node) {
  Population population;
  population.devices =
      static_cast<int>(node.at("devices").integer(2, 2147483647));
  for (const JsonNode& channel : node.at("channels").elements()) {
    const std::string name = channel.text();
    try {
      population.channels.push_back(parse_input(name));
    } catch (const std::invalid_argument& error) {
      channel.fail(error.what());
    }
  }
  const std::vector<double> T = node.at("temperatures_degC").numbers();
  const auto grid = static_cast<Index>(T.size());
  population.temperatures = array_view(T);
  const Eigen::ArrayXd& grid_T = population.temperatures;
  if (grid < 4 || !(grid_T.tail(grid - 1) > grid_T.head(grid - 1)).all())
    node.at("temperatures_degC").fail("must be 4 or more that increase");
  const Index size =
      grid * (1 + static_cast<Index>(population.channels.size()));
  population.mean = read_vector(node.at("mean"), size);
  const std::vector<JsonNode> modes = node.at("modes").elements();
  population.modes.resize(size, static_cast<Index>(modes.size()));
  for (std::size_t m = 0; m < modes.size(); ++m)
    population.modes.col(static_cast<Index>(m)) = read_vector(modes[m], size);
  return population;
}

}  // namespace beamgyro
