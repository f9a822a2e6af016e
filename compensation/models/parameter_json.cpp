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

double read_positive(const JsonNode& node) {
  const double number = node.number();
  if (!(number > 0.0)) node.fail(fmt::format("{}, must be above 0", number));
  return number;
}

}  // namespace beamgyro::internal
