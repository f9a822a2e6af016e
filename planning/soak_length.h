// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "planning/chamber_time.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro {

/// What a soak must last for.
struct SoakDemand {
  double steady = 0.05;  // [K/min], faster rows are not trained on
  int rows = 5;          // of a minute that are to be trained on
  double largest_lag =
      0.05;  // [K], mean of them, of the beam behind the sensor
};

/// Rows of one soak, by the thermal model.
struct SoakRows {
  int rows = 0;           // steady minutes
  double mean_lag = 0.0;  // [K], of the beam behind the sensor in them
};

/// Returns the rows that holds of 1, 2, 3, ... minutes have after a ramp from
/// `from` to `to` [degC] at `ramp` [K/min]; rows in which the sensor moves
/// faster than `steady` [K/min] do not count. The device is powered on at the
/// start of the ramp, everything at the temperature of the chamber. Throws as
/// simulate_temperatures().
std::vector<SoakRows> rows_over_time(const ThermalParameters& parameters,
                                     double from, double to, double ramp,
                                     double steady);

/// Returns the shortest hold [s], a whole number of minutes, after which each
/// of these soaks, reached from the start, meets the demand. Throws
/// std::invalid_argument when kLongestSoak does not suffice.
double soak_length(const ThermalParameters& parameters,
                   const std::vector<double>& soaks, const ChamberTime& time,
                   const SoakDemand& demand);

constexpr int kLongestSoak = 360;  // [min]

}  // namespace beamgyro
