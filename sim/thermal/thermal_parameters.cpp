// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_parameters.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "config/table.h"
#include "config/units.h"

namespace beamgyro::internal {
namespace {

template <class Parameters, class Fields>
void read_fields(const ConfigTable& table, const Fields& fields,
                 Parameters& parameters) {
  for (const auto& field : fields)
    parameters.*field.value =
        table.number(field.key, field.range) + field.file_offset;
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr Range kPositive{0, kNoLimit, true};
constexpr Range kNonNegative{0, kNoLimit};
constexpr Range kFraction{0, 1};
constexpr Range kHeat{1e-6, 1e6};     // [J/K]
constexpr Range kJoin{0, 1e4};        // [W/K]
constexpr Range kPower{0, 1e3};       // [W]
constexpr Range kArea{1e-8, 10};      // [m2]
constexpr Range kHeight{1e-4, 10};    // [m]
constexpr Range kConvection{0, 1e5};  // [W/m2K], boiling water

using P = ThermalParameters;
constexpr ThermalField<P> kThermalFields[] = {
    {"beam_heat_capacity_J_per_K", &P::beam_heat_capacity, kHeat},
    {"pzt_heat_capacity_J_per_K", &P::pzt_heat_capacity, kHeat},
    {"mount_heat_capacity_J_per_K", &P::mount_heat_capacity, kHeat},
    {"housing_heat_capacity_J_per_K", &P::housing_heat_capacity, kHeat},
    {"board_heat_capacity_J_per_K", &P::board_heat_capacity, kHeat},
    {"sensor_heat_capacity_J_per_K", &P::sensor_heat_capacity, kHeat},
    {"beam_pzt_conductance_W_per_K", &P::beam_pzt_conductance, kJoin},
    {"beam_mount_conductance_W_per_K", &P::beam_mount_conductance, kJoin},
    {"beam_housing_conductance_W_per_K", &P::beam_housing_conductance, kJoin},
    {"mount_housing_conductance_W_per_K", &P::mount_housing_conductance, kJoin},
    {"housing_board_conductance_W_per_K", &P::housing_board_conductance, kJoin},
    {"board_sensor_conductance_W_per_K", &P::board_sensor_conductance, kJoin},
    {"housing_sensor_conductance_W_per_K", &P::housing_sensor_conductance,
     kJoin},
    {"housing_fixture_conductance_W_per_K", &P::housing_fixture_conductance,
     kJoin},
    {"housing_area_m2", &P::housing_area, kArea},
    {"housing_height_m", &P::housing_height, kHeight},
    {"natural_convection_coefficient", &P::natural_convection_coefficient,
     kNonNegative},
    {"housing_emissivity", &P::housing_emissivity, kFraction},
    {"stirred_convection_W_per_m2K", &P::stirred_convection, kConvection},
    {"electronics_power_W", &P::electronics_power, kPower},
};

constexpr ThermalField<ThermalOven> kOvenFields[] = {
    {"set_point_degC", &ThermalOven::set_point, kMaterialTemperatures,
     kZeroCelsius},
    {"max_power_W", &ThermalOven::max_power, {0, 1e3, true}},
    {"proportional_W_per_K", &ThermalOven::proportional_gain, kPositive},
    {"integral_time_s", &ThermalOven::integral_time, kPositive},
};

template <class Parameters, class Fields>
void require_in_range(const std::string& table, const Parameters& parameters,
                      const Fields& fields) {
  for (const auto& field : fields) {
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

ThermalParameters read_thermal(const ConfigTable& thermal) {
  ThermalParameters parameters;
  read_fields(thermal, kThermalFields, parameters);
  if (const auto oven = thermal.optional_table("oven"))
    read_fields(*oven, kOvenFields, parameters.oven.emplace());
  require_valid(parameters);
  return parameters;
}

std::span<const ThermalField<ThermalParameters>> thermal_fields() {
  return kThermalFields;
}

void require_valid(const ThermalParameters& parameters) {
  require_in_range("thermal.", parameters, kThermalFields);
  if (parameters.oven)
    require_in_range("thermal.oven.", *parameters.oven, kOvenFields);
  require_joined(parameters);
}

}  // namespace beamgyro::internal
