// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace beamgyro {

struct TemperatureSensorParameters {
  double noise = 0.0;       // one sigma, white from sample to sample [K]
  double resolution = 0.0;  // 0 = none [K]
  double offset = 0.0;      // [K]
};

/// What the temperature sensor shows [degC], one reading per temperature [K] of
/// its node: the multiple of `resolution` on the Celsius scale nearest to
///   temperature + offset + noise n,  n from the stream kTemperatureSensor.
/// Without noise, offset and resolution stay. Throws std::invalid_argument for
/// noise or resolution below 0, or a parameter that is not finite.
std::vector<double> temperature_readings(
    const TemperatureSensorParameters& parameters, bool noise_enabled,
    std::span<const double> temperature, std::uint64_t seed,
    std::uint32_t device, std::uint32_t run);

}  // namespace beamgyro
