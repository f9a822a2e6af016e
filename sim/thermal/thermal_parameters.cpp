// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_parameters.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "config/units.h"
#include "sim/thermal/material_range.h"

namespace beamgyro {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr Range kPositive{0, kNoLimit, true};
constexpr Range kNonNegative{0, kNoLimit};
constexpr Range kFraction{0, 1};

using P = ThermalParameters;
constexpr ThermalField<P> kThermalFields[] = {
    {"beam_heat_capacity_J_per_K", &P::beam_heat_capacity, kPositive},
    {"pzt_heat_capacity_J_per_K", &P::pzt_heat_capacity, kPositive},
    {"mount_heat_capacity_J_per_K", &P::mount_heat_capacity, kPositive},
    {"housing_heat_capacity_J_per_K", &P::housing_heat_capacity, kPositive},
    {"board_heat_capacity_J_per_K", &P::board_heat_capacity, kPositive},
    {"sensor_heat_capacity_J_per_K", &P::sensor_heat_capacity, kPositive},
    {"beam_pzt_conductance_W_per_K", &P::beam_pzt_conductance, kNonNegative},
    {"beam_mount_conductance_W_per_K", &P::beam_mount_conductance,
     kNonNegative},
    {"beam_housing_conductance_W_per_K", &P::beam_housing_conductance,
     kNonNegative},
    {"mount_housing_conductance_W_per_K", &P::mount_housing_conductance,
     kNonNegative},
    {"housing_board_conductance_W_per_K", &P::housing_board_conductance,
     kNonNegative},
    {"board_sensor_conductance_W_per_K", &P::board_sensor_conductance,
     kNonNegative},
    {"housing_sensor_conductance_W_per_K", &P::housing_sensor_conductance,
     kNonNegative},
    {"housing_fixture_conductance_W_per_K", &P::housing_fixture_conductance,
     kNonNegative},
    {"housing_area_m2", &P::housing_area, kPositive},
    {"housing_height_m", &P::housing_height, kPositive},
    {"natural_convection_coefficient", &P::natural_convection_coefficient,
     kNonNegative},
    {"housing_emissivity", &P::housing_emissivity, kFraction},
    {"stirred_convection_W_per_m2K", &P::stirred_convection, kNonNegative},
    {"electronics_power_W", &P::electronics_power, kNonNegative},
};

constexpr ThermalField<ThermalOven> kOvenFields[] = {
    {"set_point_degC", &ThermalOven::set_point, kMaterialTemperatures,
     kZeroCelsius},
    {"max_power_W", &ThermalOven::max_power, kPositive},
    {"proportional_W_per_K", &ThermalOven::proportional_gain, kPositive},
    {"integral_time_s", &ThermalOven::integral_time, kPositive},
};

template <class Parameters>
void require_in_range(const std::string& table, const Parameters& parameters,
                      std::span<const ThermalField<Parameters>> fields) {
  for (const ThermalField<Parameters>& field : fields) {
    const double value = parameters.*field.value - field.file_offset;
    if (field.range.contains(value)) continue;
    throw std::invalid_argument(fmt::format(
        "{}{}: {} is not {}", table, field.key, value, text_of(field.range)));
  }
}

// A node without a way out would heat for ever and has no steady state.
void require_joined(const ThermalParameters& p) {
  const bool mount =
      p.mount_housing_conductance > 0 ||
      (p.beam_mount_conductance > 0 && p.beam_housing_conductance > 0);
  const bool beam =
      p.beam_housing_conductance > 0 ||
      (p.beam_mount_conductance > 0 && p.mount_housing_conductance > 0);
  const bool board =
      p.housing_board_conductance > 0 ||
      (p.board_sensor_conductance > 0 && p.housing_sensor_conductance > 0);
  const bool sensor =
      p.housing_sensor_conductance > 0 ||
      (p.board_sensor_conductance > 0 && p.housing_board_conductance > 0);
  const bool outside = p.housing_fixture_conductance > 0 ||
                       p.natural_convection_coefficient > 0 ||
                       p.housing_emissivity > 0;
  const auto require = [](bool joined, const char* node, const char* to) {
    if (joined) return;
    throw std::invalid_argument(fmt::format(
        "thermal: no conductance above zero joins the {} to the {}", node, to));
  };
  require(beam, "beam", "housing");
  require(p.beam_pzt_conductance > 0, "pzt", "beam");
  require(mount, "mount", "housing");
  require(board, "board", "housing");
  require(sensor, "sensor", "housing");
  require(outside, "housing", "surroundings");
}

}  // namespace

std::span<const ThermalField<ThermalParameters>> thermal_fields() {
  return kThermalFields;
}

std::span<const ThermalField<ThermalOven>> oven_fields() { return kOvenFields; }

void require_valid(const ThermalParameters& parameters) {
  require_in_range("thermal.", parameters, thermal_fields());
  if (parameters.oven) {
    require_in_range("thermal.oven.", *parameters.oven, oven_fields());
  }
  require_joined(parameters);
}

}  // namespace beamgyro
