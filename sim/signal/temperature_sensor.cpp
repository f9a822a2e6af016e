// SPDX-License-Identifier: MIT
#include "sim/signal/temperature_sensor.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "config/units.h"
#include "sim/signal/readout.h"

namespace beamgyro::internal {

double sensed_temperature(const TemperatureSensorParameters& parameters,
                          double temperature, double n) {
  return (temperature - kZeroCelsius) + parameters.offset +
         parameters.noise * n;
}

TemperatureSensor::TemperatureSensor(
    const TemperatureSensorParameters& parameters, bool noise_enabled,
    std::uint64_t seed, std::uint32_t device, std::uint32_t run)
    : parameters_(parameters),
      stream_(seed, device, run, kTemperatureSensorStream) {
  if (!(parameters.noise >= 0.0) || !std::isfinite(parameters.noise))
    throw std::invalid_argument(
        fmt::format("temperature sensor noise is {} K, must be 0 or more",
                    parameters.noise));
  if (!std::isfinite(parameters.offset))
    throw std::invalid_argument(
        fmt::format("temperature sensor offset is {} K, must be finite",
                    parameters.offset));
  quantise(0.0, parameters.resolution);
  if (!noise_enabled) parameters_.noise = 0.0;
}

std::vector<double> TemperatureSensor::readings(
    std::span<const double> temperature) {
  std::vector<double> readings(temperature.size(), 0.0);
  if (parameters_.noise > 0.0) stream_.fill_normal(readings);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i] = sensed_temperature(parameters_, temperature[i], readings[i]);
  quantise(readings, parameters_.resolution);
  return readings;
}

}  // namespace beamgyro::internal
