// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "compensation/bias_model.h"
#include "dataset/json_node.h"

namespace beamgyro {

/// Returns the number as JSON. Throws std::runtime_error when it is not finite.
nlohmann::ordered_json finite_json(double value);

/// Returns an array of numbers, each as finite_json().
template <class Numbers>
nlohmann::ordered_json numbers_json(const Numbers& numbers) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const double number : numbers) array.push_back(finite_json(number));
  return array;
}

/// Adds the keys of a model, `input_scales`, `bias_scale` and `parameters`
/// (docs/reference/compensator_file.md), to `json`. Throws as finite_json().
void put_bias_model(const BiasModel& model, nlohmann::ordered_json& json);

/// Reads the name of a kind of model. Throws as JsonNode when there is no such
/// kind.
std::string read_bias_kind(const JsonNode& node);

/// Reads what put_bias_model() wrote for a model of that kind and so many
/// inputs. Throws as JsonNode.
BiasModel read_bias_model(const JsonNode& node, const std::string& kind,
                          std::size_t inputs);

/// Reads temperatures that increase, and as many numbers under the key
/// `values`.
LookupTable read_lookup_table(const JsonNode& node, const std::string& values);

}  // namespace beamgyro
