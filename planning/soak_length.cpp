// SPDX-License-Identifier: MIT
#include "planning/soak_length.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "config/units.h"
#include "planning/chamber_view.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro {
namespace {

constexpr double kMinute = 60.0;  // [s]

std::vector<double> minutes_from(double begin, int count) {
  std::vector<double> times;
  for (int k = 0; k <= count; ++k) times.push_back(begin + k * kMinute);
  return times;
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

double soak_length(const ThermalParameters& parameters,
                   const std::vector<double>& soaks, const ChamberTime& time,
                   const SoakDemand& demand) {
  int longest = 0;
  for (const double soak : soaks) {
    const std::vector<SoakRows> rows =
        rows_over_time(parameters, time.start, soak, time.ramp, demand.steady);
    const auto enough = std::ranges::find_if(rows, [&](const SoakRows& now) {
      return now.rows >= demand.rows &&
             std::abs(now.mean_lag) <= demand.largest_lag;
    });
    if (enough == rows.end())
      throw std::invalid_argument(fmt::format(
          "a soak at {:g} degC does not settle within {} min to {:g} K/min and "
          "a lag of the beam of {:.3g} K; expected --hold with the length that "
          "is wanted",
          soak, kLongestSoak, demand.steady, demand.largest_lag));
    longest = std::max(longest, static_cast<int>(enough - rows.begin()) + 1);
  }
  return longest * kMinute;
}

}  // namespace beamgyro
