// SPDX-License-Identifier: MIT
#include "compensation/firmware/firmware_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace beamgyro::internal {

const std::vector<float>& FirmwareArrays::values(std::string_view name) const {
  const auto array = std::ranges::find(arrays_, name, &FirmwareArray::name);
  if (array == arrays_.end())
    throw std::logic_error(fmt::format("no constants {}", name));
  return array->values;
}

float single(double value) {
  const auto result = static_cast<float>(value);
  if (!std::isfinite(result))
    throw std::invalid_argument(
        fmt::format("the parameter {} does not fit single precision", value));
  return result;
}

}  // namespace beamgyro::internal
