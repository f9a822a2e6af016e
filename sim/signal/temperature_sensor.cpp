// SPDX-License-Identifier: MIT
#include "sim/signal/temperature_sensor.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "dataset/random_stream.h"
#include "sim/signal/readout.h"

namespace beamgyro {

std::vector<double> temperature_readings(
    const TemperatureSensorParameters& parameters, bool noise_enabled,
    std::span<const double> temperature, std::uint64_t seed,
    std::uint32_t device, std::uint32_t run) {
  if (!(parameters.noise >= 0.0) || !std::isfinite(parameters.noise))
    throw std::invalid_argument(
        fmt::format("temperature sensor noise is {} K, must be 0 or more",
                    parameters.noise));
  if (!std::isfinite(parameters.offset))
    throw std::invalid_argument(
        fmt::format("temperature sensor offset is {} K, must be finite",
                    parameters.offset));
  constexpr double kZeroCelsius = 273.15;  // [K]
  std::vector<double> readings(temperature.size(), 0.0);
  const double noise = noise_enabled ? parameters.noise : 0.0;
  if (noise > 0.0)
    RandomStream(seed, device, run, RandomPurpose::kTemperatureSensor)
        .fill_normal(readings);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i] = quantise((temperature[i] - kZeroCelsius) + parameters.offset +
                               noise * readings[i],
                           parameters.resolution);
  return readings;
}

}  // namespace beamgyro
