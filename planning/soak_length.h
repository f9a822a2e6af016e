// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "planning/chamber_time.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

// Rows that scenarios/population/adapted.toml trains on.
constexpr double kSteady = 0.05;     // [K/min], faster rows are left out
constexpr int kLeastSteadyRows = 5;  // of a minute, that a soak should have

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

/// Returns rows_over_time() of that soak, of some that are each reached from
/// the start, whose beam lags most. A unit is slower by as much as its heat
/// capacities may be larger than the parameters say: all are taken
/// 1 + kCapacityMargin times.
std::vector<SoakRows> slowest_rows(const ThermalParameters& parameters,
                                   const std::vector<double>& soaks,
                                   const ChamberTime& time, double steady);

/// Returns the size of the mean lag [K] in the rows of a hold of so many
/// minutes after a ramp of `ramp` whole minutes, given `rows` of a soak whose
/// ramp was so long that the lag no longer grew. A shorter ramp is that one
/// less one that ended `ramp` earlier, because the heat flow is linear. Rows
/// are the last minutes of the hold. Throws std::out_of_range for holds that
/// `rows` has not.
double mean_lag(const std::vector<SoakRows>& rows, std::size_t minutes,
                std::size_t ramp);

constexpr double kCapacityMargin = 0.1;  // [-]

constexpr int kLongestSoak = 360;  // [min]

}  // namespace beamgyro::internal
