// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string_view>

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

/// Returns an array of the rows of a matrix, each as numbers_json().
nlohmann::ordered_json rows_json(const Eigen::MatrixXd& matrix);

/// Read what numbers_json(), rows_json() and finite_json() wrote, with `size`
/// numbers each; `what` ends the message of another size. Throw as JsonNode.
Eigen::ArrayXd read_array(const JsonNode& node);
Eigen::ArrayXd read_array(const JsonNode& node, Eigen::Index size,
                          std::string_view what = {});
Eigen::MatrixXd read_matrix(const JsonNode& node, Eigen::Index size,
                            std::string_view what = {});
double read_positive(const JsonNode& node);

}  // namespace beamgyro::internal
