// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "config/range.h"

namespace beamgyro::internal {

class ConfigTable;

/// Temperatures that the materials of a gyro stand [degC]. Files, options and
/// runs are held against this one range.
/// - Hard PZT has its Curie point at about 300 degC and keeps its polarisation
///   up to half of that in degC, the rule of its makers.
/// - Epoxies of the bond are rated to 150 degC at most.
/// - Below -100 degC the data of epoxy and elastomer end: both are glasses that
///   crack when the parts that they join shrink.
inline constexpr Range kMaterialTemperatures{-100, 150};

/// Where the linear coefficients of the ceramic hold [degC], kColdestCeramic to
/// kHottestCeramic of the device. Beyond they keep the values of the nearest
/// end.
inline constexpr Range kLinearCeramic{-40, 80};

/// What the range of the materials stands for in messages.
inline constexpr const char* kMaterialReason =
    "the temperatures that ceramic and bond stand";

/// Heater and controller of an oven around beam and mount; equation (4.3) in
/// thermal_ode.h. Its can and insulation are conductances of the network.
struct ThermalOven {
  double set_point = 338.15;       // [K], of the mount
  double max_power = 3.0;          // [W]
  double proportional_gain = 1.0;  // [W/K]
  double integral_time = 60.0;     // [s]
};

/// Six lumps of heat and what joins them; the defaults are the nominal unit.
struct ThermalParameters {
  double beam_heat_capacity = 1.46;     // [J/K]
  double pzt_heat_capacity = 0.08;      // [J/K], patches with their bond
  double mount_heat_capacity = 1.8;     // [J/K], elastomer and base
  double housing_heat_capacity = 42.0;  // [J/K]
  double board_heat_capacity = 6.0;     // [J/K]
  double sensor_heat_capacity = 0.25;   // [J/K]

  double beam_pzt_conductance = 0.5;           // [W/K], bond
  double beam_mount_conductance = 4.0e-3;      // [W/K], pins
  double beam_housing_conductance = 4.5e-3;    // [W/K], air gap
  double mount_housing_conductance = 0.05;     // [W/K]
  double housing_board_conductance = 0.12;     // [W/K]
  double board_sensor_conductance = 0.004;     // [W/K]
  double housing_sensor_conductance = 0.004;   // [W/K]
  double housing_fixture_conductance = 0.060;  // [W/K], fixture at ambient

  double housing_area = 8.0e-3;                  // [m^2], to air and to walls
  double housing_height = 0.04;                  // [m]
  double natural_convection_coefficient = 1.42;  // [W m^-7/4 K^-5/4]
  double housing_emissivity = 0.25;
  double stirred_convection = 20.0;  // [W/(m^2 K)], stirred chamber only

  double electronics_power = 0.60;  // [W], into the board while powered
  std::optional<ThermalOven> oven;
};

/// One number of `Parameters`, its key in a device file and what the file may
/// say. The file holds value - file_offset: degC for a temperature in [K].
template <class Parameters>
struct ThermalField {
  const char* key;
  double Parameters::*value;
  Range range;
  double file_offset = 0;
};

std::span<const ThermalField<ThermalParameters>> thermal_fields();

/// Throws std::invalid_argument naming the first field that is not a finite
/// number in its range, or the node no conductance joins to the housing.
void require_valid(const ThermalParameters& parameters);

/// The table [thermal] of a device file: every key of thermal_fields(), and
/// those of an oven if there is a table `oven`. Throws
/// std::invalid_argument as ConfigTable and require_valid() do.
ThermalParameters read_thermal(const ConfigTable& thermal);

}  // namespace beamgyro::internal
