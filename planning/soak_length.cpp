// SPDX-License-Identifier: MIT
#include "planning/soak_length.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "config/units.h"
#include "planning/chamber_view.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {
namespace {

constexpr double kMinute = 60.0;  // [s]

std::vector<double> minutes_from(double begin, int count) {
  std::vector<double> times;
  for (int k = 0; k <= count; ++k) times.push_back(begin + k * kMinute);
  return times;
}

ThermalParameters slower(ThermalParameters parameters) {
  for (double* capacity :
       {&parameters.beam_heat_capacity, &parameters.pzt_heat_capacity,
        &parameters.mount_heat_capacity, &parameters.housing_heat_capacity,
        &parameters.board_heat_capacity, &parameters.sensor_heat_capacity})
    *capacity *= 1.0 + kCapacityMargin;
  return parameters;
}

}  // namespace

std::vector<SoakRows> rows_over_time(const ThermalParameters& parameters,
                                     double from, double to, double ramp,
                                     double steady) {
  const double begin = std::abs(to - from) / ramp * kMinute;
  std::vector<double> times = {0.0}, values = {from + kZeroCelsius};
  if (begin > 0.0) {
    times.push_back(begin);
    values.push_back(to + kZeroCelsius);
  }
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork(parameters),
      {.ambient = {times, values}, .stirred = true, .powered = {{.on = 0.0}}},
      minutes_from(begin, kLongestSoak));
  const double excess = ChamberView(parameters).beam_excess(to);
  const auto& sensor = history.temperature[kSensor];
  const auto& beam = history.temperature[kBeam];
  std::vector<SoakRows> found;
  SoakRows rows;
  double lags = 0.0;
  for (std::size_t k = 1; k < sensor.size(); ++k) {
    if (std::abs(sensor[k] - sensor[k - 1]) <= steady) {
      ++rows.rows;
      lags += (beam[k] - sensor[k] + beam[k - 1] - sensor[k - 1]) / 2 - excess;
      rows.mean_lag = lags / rows.rows;
    }
    found.push_back(rows);
  }
  return found;
}

std::vector<SoakRows> slowest_rows(const ThermalParameters& parameters,
                                   const std::vector<double>& soaks,
                                   const ChamberTime& time, double steady) {
  const ThermalParameters slow = slower(parameters);
  std::vector<SoakRows> found;
  for (const double soak : soaks) {
    std::vector<SoakRows> rows =
        rows_over_time(slow, time.start, soak, time.ramp, steady);
    if (found.empty() ||
        std::abs(rows.back().mean_lag) > std::abs(found.back().mean_lag))
      found = std::move(rows);
  }
  return found;
}

double mean_lag(const std::vector<SoakRows>& rows, std::size_t minutes,
                std::size_t ramp) {
  const SoakRows& hold = rows.at(minutes - 1);
  if (hold.rows == 0) return 0.0;
  // Sum of the lags of the rows from the start of the hold to a minute of it.
  const auto sum = [&](std::size_t minute) {
    if (minute == 0) return 0.0;
    const SoakRows& now = rows[std::min(minute, rows.size()) - 1];
    return now.rows * now.mean_lag;
  };
  const std::size_t first = minutes - static_cast<std::size_t>(hold.rows);
  return std::abs(sum(minutes) - (sum(minutes + ramp) - sum(first + ramp))) /
         hold.rows;
}

}  // namespace beamgyro::internal
