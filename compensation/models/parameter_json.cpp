// SPDX-License-Identifier: MIT
#include "compensation/models/parameter_json.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace beamgyro {

nlohmann::ordered_json finite_json(double value) {
  if (!std::isfinite(value))
    throw std::runtime_error(fmt::format(
        "the compensator has a parameter that is {}; not written", value));
  return value;
}

}  // namespace beamgyro
