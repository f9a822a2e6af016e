// SPDX-License-Identifier: MIT
#include "api/beam_temperatures.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "config/option_message.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

void require_material_temperatures(std::span<const double> temperatures) {
  if (temperatures.empty())
    throw std::invalid_argument("no temperatures; expected at least one");
  for (const double celsius : temperatures)
    if (!kMaterialTemperatures.contains(celsius))
      throw option_error("{}: {} degC is beyond {:g} to {:g} degC, {}",
                         NamedOption{"beam_temperature"}, celsius,
                         kMaterialTemperatures.low, kMaterialTemperatures.high,
                         kMaterialReason);
}

std::vector<std::string> ceramic_warnings(std::span<const double> temperatures,
                                          const std::string& name) {
  const bool is_linear = std::ranges::all_of(temperatures, [](double celsius) {
    return kLinearCeramic.contains(celsius);
  });
  if (is_linear) return {};
  return {fmt::format(
      "{}: beyond {:g} to {:g} degC the ceramic's coefficients keep the values "
      "of the nearest end",
      name, kLinearCeramic.low, kLinearCeramic.high)};
}

}  // namespace beamgyro::internal
