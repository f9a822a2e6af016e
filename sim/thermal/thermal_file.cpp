// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_file.h"

#include <span>

namespace beamgyro::internal {
namespace {

template <class Parameters>
void read_fields(const ConfigTable& table,
                 std::span<const ThermalField<Parameters>> fields,
                 Parameters& parameters) {
  for (const ThermalField<Parameters>& field : fields) {
    parameters.*field.value =
        table.number(field.key, field.range) + field.file_offset;
  }
}

}  // namespace

ThermalParameters read_thermal(const ConfigTable& thermal) {
  ThermalParameters parameters;
  read_fields(thermal, thermal_fields(), parameters);
  if (const auto oven = thermal.optional_table("oven")) {
    read_fields(*oven, oven_fields(), parameters.oven.emplace());
  }
  require_valid(parameters);
  return parameters;
}

}  // namespace beamgyro::internal
