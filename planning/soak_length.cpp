// SPDX-License-Identifier: MIT
#include "planning/soak_length.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/units.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {
namespace {

constexpr double kMinute = 60.0;  // [s]

ThermalParameters slower(ThermalParameters parameters) {
  for (double* capacity :
       {&parameters.beam_heat_capacity, &parameters.pzt_heat_capacity,
        &parameters.mount_heat_capacity, &parameters.housing_heat_capacity,
        &parameters.board_heat_capacity, &parameters.sensor_heat_capacity})
    *capacity *= 1.0 + kCapacityMargin;
  return parameters;
}

// Powered on at 0, held at `from` [degC], then a ramp to `to`.
struct Ramp {
  double from, to;      // [degC]
  double ramp;          // [K/min]
  double before = 0.0;  // [s], of the hold at `from`

  double end() const { return before + std::abs(to - from) / ramp * kMinute; }
};

// Minutes from `first` [s] on. The lag counts from that of a chamber at
// `settled` [degC].
struct Minutes {
  std::vector<double> sensor;  // [degC], means
  std::vector<double> rate;    // [K/min], of the sensor
  std::vector<double> lag;     // [K], of the beam behind the sensor
};
Minutes minutes_of(const ThermalParameters& parameters, const Ramp& ramp,
                   double first, int count, double settled) {
  std::vector<double> times = {0.0}, values = {ramp.from + kZeroCelsius};
  if (ramp.before > 0.0) {
    times.push_back(ramp.before);
    values.push_back(values.back());
  }
  if (ramp.end() > ramp.before) {
    times.push_back(ramp.end());
    values.push_back(ramp.to + kZeroCelsius);
  }
  std::vector<double> wanted;
  for (int k = 0; k <= count; ++k) wanted.push_back(first + k * kMinute);
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork(parameters),
      {.ambient = {times, values}, .stirred = true, .powered = {{.on = 0.0}}},
      wanted);
  const double excess = ChamberView(parameters).beam_excess(settled);
  const auto& sensor = history.temperature[kSensor];
  const auto& beam = history.temperature[kBeam];
  Minutes found;
  for (std::size_t k = 1; k < sensor.size(); ++k) {
    found.sensor.push_back((sensor[k] + sensor[k - 1]) / 2 - kZeroCelsius);
    found.rate.push_back(sensor[k] - sensor[k - 1]);
    found.lag.push_back(
        (beam[k] - sensor[k] + beam[k - 1] - sensor[k - 1]) / 2 - excess);
  }
  return found;
}

Minutes minutes_of_hold(const ThermalParameters& parameters, const Ramp& ramp) {
  return minutes_of(parameters, ramp, ramp.end(), kLongestSoak, ramp.to);
}

}  // namespace

double temperature_noise(double resolution, const RowRule& rule) {
  constexpr double kSpan = 2.0;  // [min]
  return resolution / std::sqrt(12.0) *
         std::hypot(1.0, std::numbers::sqrt2 * rule.lag / kSpan);
}

double lag_minutes(const ThermalParameters& parameters, double from,
                   double ramp, double steady) {
  const Minutes hold = minutes_of_hold(
      parameters, {from, from + kUsualStep, ramp, kLongestSoak * kMinute});
  double product = 0.0, square = 0.0;
  for (std::size_t k = 0; k < hold.rate.size(); ++k)
    if (std::abs(hold.rate[k]) <= steady) {
      product += hold.lag[k] * hold.rate[k];
      square += hold.rate[k] * hold.rate[k];
    }
  const double lag = square > 0.0 ? -product / square : 0.0;
  return std::max(std::round(lag * 10.0) / 10.0, 0.0);
}

std::vector<SoakRows> rows_over_time(const ThermalParameters& parameters,
                                     double from, double to, double ramp,
                                     const RowRule& rule) {
  const Minutes hold = minutes_of_hold(parameters, {from, to, ramp});
  std::vector<SoakRows> found;
  SoakRows rows;
  double lags = 0.0, rests = 0.0;
  const double settled = hold.sensor.back();
  for (std::size_t k = 0; k < hold.rate.size(); ++k) {
    if (std::abs(hold.rate[k]) <= rule.steady) {
      ++rows.rows;
      lags += hold.lag[k] + rule.lag * hold.rate[k];
      rests += hold.sensor[k] - rule.lag * hold.rate[k] - settled;
      rows.mean_lag = lags / rows.rows;
      rows.mean_rest = rests / rows.rows;
    }
    found.push_back(rows);
  }
  return found;
}

std::vector<SoakRows> slowest_rows(const ThermalParameters& parameters,
                                   double farthest, const ChamberTime& time,
                                   const RowRule& rule) {
  return rows_over_time(slower(parameters), time.start, farthest, time.ramp,
                        rule);
}

std::optional<StartRow> start_row(const ThermalParameters& parameters,
                                  double lowest, const ChamberTime& time,
                                  const RowRule& rule) {
  const double minutes = (time.start - lowest) / time.ramp;
  if (!(minutes >= 1.0) || time.ramp <= rule.steady) return {};
  const ThermalParameters slow = slower(parameters);
  const Minutes ramp = minutes_of(
      slow, {time.start, lowest, time.ramp}, 0.0,
      static_cast<int>(std::min(minutes, 1.0 * kLongestSoak)), time.start);
  double sensor = 0.0, lag = 0.0;
  int rows = 0;
  for (std::size_t k = 0; k < ramp.rate.size(); ++k) {
    if (std::abs(ramp.rate[k]) <= rule.steady) {
      sensor += ramp.sensor[k] - rule.lag * ramp.rate[k];
      lag += ramp.lag[k] + rule.lag * ramp.rate[k];
      ++rows;
    } else if (rows > 0) {
      return StartRow{ChamberView(slow).chamber_temperature(sensor / rows),
                      lag / rows, static_cast<double>(k) * time.ramp};
    }
  }
  return {};
}

bool has_start_row(const std::vector<double>& soaks, double start,
                   const StartRow& row) {
  return !soaks.empty() &&
         in_visiting_order(soaks, start).front() <= start - row.way;
}

std::vector<double> with_start_row(std::vector<double> soaks,
                                   const std::optional<StartRow>& row) {
  if (row) soaks.push_back(row->temperature);
  return soaks;
}

double mean_after_ramp(const std::vector<SoakRows>& rows, std::size_t minutes,
                       std::size_t ramp, double SoakRows::*mean) {
  const SoakRows& hold = rows.at(minutes - 1);
  if (hold.rows == 0) return 0.0;
  // Sum over the rows from the start of the hold to a minute of it.
  const auto sum = [&](std::size_t minute) {
    if (minute == 0) return 0.0;
    const SoakRows& now = rows[std::min(minute, rows.size()) - 1];
    return now.rows * (now.*mean);
  };
  const std::size_t first = minutes - static_cast<std::size_t>(hold.rows);
  return std::abs(sum(minutes) - (sum(minutes + ramp) - sum(first + ramp))) /
         hold.rows;
}

}  // namespace beamgyro::internal
