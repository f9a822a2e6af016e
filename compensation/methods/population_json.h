// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "compensation/methods/population.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Reads names of inputs (parse_input()). Throws as JsonNode.
std::vector<Input> read_inputs(const JsonNode& node);

/// Returns the value of the key `population` of a compensator file
/// (docs/reference/compensator_file.md). Throws std::runtime_error for a number
/// that is not finite.
nlohmann::ordered_json population_json(const Population& population);

/// Reads a value that population_json() wrote. Throws as JsonNode.
Population read_population(const JsonNode& node);

}  // namespace beamgyro::internal
