// SPDX-License-Identifier: MIT
#include "validation/page/figures.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace beamgyro {

nlohmann::ordered_json figures_of(const Evidence& before,
                                  const Evidence& after) {
  if (before.runs.size() != after.runs.size())
    throw std::invalid_argument("figures need the same runs before and after");
  return nlohmann::ordered_json::array();
}

nlohmann::ordered_json population_figure(const PopulationFigure& figure) {
  return {{"id", "population_yield"}, {"title", figure.name}};
}

}  // namespace beamgyro
