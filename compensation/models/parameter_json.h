// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Returns the number as JSON. Throws std::runtime_error when it is not finite.
nlohmann::ordered_json finite_json(double value);

/// Returns an array of numbers, each as finite_json().
template <class Numbers>
nlohmann::ordered_json numbers_json(const Numbers& numbers) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const double number : numbers) array.push_back(finite_json(number));
  return array;
}

/// Read what numbers_json() and finite_json() wrote. Throw as JsonNode.
Eigen::ArrayXd read_array(const JsonNode& node);
double read_positive(const JsonNode& node);

}  // namespace beamgyro::internal
