// SPDX-License-Identifier: MIT
#include "compensation/models/parameter_json.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "compensation/models/array_view.h"

namespace beamgyro::internal {

nlohmann::ordered_json finite_json(double value) {
  if (!std::isfinite(value))
    throw std::runtime_error(fmt::format(
        "the compensator has a parameter that is {}; not written", value));
  return value;
}

Eigen::ArrayXd read_array(const JsonNode& node) {
  const std::vector<double> numbers = node.numbers();
  return array_view(numbers);
}

nlohmann::ordered_json rows_json(const Eigen::MatrixXd& matrix) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : matrix.rowwise()) rows.push_back(numbers_json(row));
  return rows;
}

Eigen::ArrayXd read_array(const JsonNode& node, Eigen::Index size,
                          std::string_view what) {
  Eigen::ArrayXd numbers = read_array(node);
  if (numbers.size() != size)
    node.fail(
        fmt::format("{} numbers, must be {}{}", numbers.size(), size, what));
  return numbers;
}

Eigen::MatrixXd read_matrix(const JsonNode& node, Eigen::Index size,
                            std::string_view what) {
  const std::vector<JsonNode> rows = node.elements();
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), size);
  for (std::size_t k = 0; k < rows.size(); ++k)
    matrix.row(static_cast<Eigen::Index>(k)) =
        read_array(rows[k], size, what).matrix();
  return matrix;
}

double read_positive(const JsonNode& node) {
  const double number = node.number();
  if (!(number > 0.0)) node.fail(fmt::format("{}, must be above 0", number));
  return number;
}

}  // namespace beamgyro::internal
