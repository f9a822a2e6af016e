// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planning/chamber.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

// Rows that scenarios/population/adapted.toml trains on.
constexpr double kSteady = 0.2;        // [K/min], faster rows are left out
constexpr double kAfterPowerOn = 5.0;  // [min], earlier rows are left out
constexpr int kLeastSteadyRows = 5;    // of a minute, that a soak should have

/// Rows of one soak, by the thermal model.
struct SoakRows {
  int rows = 0;           // steady minutes
  double mean_lag = 0.0;  // [K], of the beam behind their temperature
  // [K], of their temperature from that to which the sensor settles
  double mean_rest = 0.0;
};

/// A row that stands for the temperature of the device at power-on.
struct StartRow {
  double temperature;  // [degC], of a chamber in which it would be settled
  double lag;          // [K], of the beam: it is warmer by this
  double way;          // [K], at least, from the start down to the first soak
};

/// How the rows of a device are chosen and read, as `train` does it.
struct RowRule {
  double steady = kSteady;  // [K/min], faster rows are left out
  double lag = 0.0;  // [min]: a row is at T - lag dT/dt of the sensor's T
  double after_power_on = 0.0;  // [min], of the first row
};

/// Returns the 1-sigma [K] of the temperature that the rows of a soak are read
/// at, of a sensor that rounds to `resolution` [K]. Most rows of a short hold
/// have no more than two steady neighbours on one side, and a rate over two
/// minutes, both ends of which are rounded.
double temperature_noise(double resolution, const RowRule& rule);

/// Returns the lag [min] that rows should be read with, to a tenth: after a
/// ramp of kUsualStep from `from` [degC], settled, the beam lags behind the
/// sensor by -lag dT/dt, least squares over the steady minutes.
double lag_minutes(const ThermalParameters& parameters, double from,
                   double ramp, double steady);

constexpr double kUsualStep = -20.0;  // [K], from soak to soak

/// Returns the rows that holds of 1, 2, 3, ... minutes have after a ramp from
/// `from` to `to` [degC] at `ramp` [K/min]. The device is powered on at the
/// start of the ramp, everything at the temperature of the chamber. Throws as
/// simulate_temperatures().
std::vector<SoakRows> rows_over_time(const ThermalParameters& parameters,
                                     double from, double to, double ramp,
                                     const RowRule& rule);

/// Returns rows_over_time() of the soak that is farthest from the start, whose
/// beam lags most. A unit is slower by as much as its heat capacities may be
/// larger than the parameters say: all are taken 1 + kCapacityMargin times.
std::vector<SoakRows> slowest_rows(const ThermalParameters& parameters,
                                   double farthest, const ChamberTime& time,
                                   const RowRule& rule);

/// Returns the row that a ramp down from the start has minutes after power-on:
/// the electronics heat the sensor as fast as the chamber cools it, and the
/// beam is still warm. `lowest` [degC] ends the ramp. Nothing when no row is
/// steady.
std::optional<StartRow> start_row(const ThermalParameters& parameters,
                                  double lowest, const ChamberTime& time,
                                  const RowRule& rule);

/// Returns whether the way through the soaks goes down from the start as far as
/// the row needs.
bool has_start_row(const std::vector<double>& soaks, double start,
                   const StartRow& row);

/// Returns the soaks, and behind them the temperature of the row, if any.
std::vector<double> with_start_row(std::vector<double> soaks,
                                   const std::optional<StartRow>& row);

/// Returns the size of a mean of SoakRows [K], its lag or its rest, in the rows
/// of a hold of so many minutes after a ramp of `ramp` whole minutes, given
/// `rows` of a soak whose ramp was so long that the lag no longer grew. A
/// shorter ramp is that one less one that ended `ramp` earlier, because the
/// heat flow is linear. Rows are the last minutes of the hold. Throws
/// std::out_of_range for holds that `rows` has not.
double mean_after_ramp(const std::vector<SoakRows>& rows, std::size_t minutes,
                       std::size_t ramp, double SoakRows::*mean);

constexpr double kCapacityMargin = 0.1;  // [-]

constexpr int kLongestSoak = 360;  // [min]

}  // namespace beamgyro::internal
