// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "random/random_stream.h"

namespace beamgyro::internal {

struct TemperatureSensorParameters {
  double noise = 0.0;       // one sigma, white from sample to sample [K]
  double resolution = 0.0;  // 0 = none [K]
  double offset = 0.0;      // [K]
};

/// Returns what a sensor shows of `temperature` [K], in [degC] and before its
/// resolution, with the number n of its noise.
double sensed_temperature(const TemperatureSensorParameters& parameters,
                          double temperature, double n);

/// The temperature sensor. A reading [degC] is the multiple of `resolution` on
/// the Celsius scale that is nearest to
///   temperature + offset + noise n,  n from the stream kTemperatureSensor.
/// When noise is disabled, offset and resolution stay. The readings do not
/// depend on how a run is cut into calls.
class TemperatureSensor {
 public:
  /// Throws std::invalid_argument for noise or resolution below 0, or a
  /// parameter that is not finite.
  TemperatureSensor(const TemperatureSensorParameters& parameters,
                    bool noise_enabled, std::uint64_t seed,
                    std::uint32_t device, std::uint32_t run);

  /// Returns the readings of the next samples, whose node has these
  /// temperatures [K].
  std::vector<double> readings(std::span<const double> temperature);

 private:
  TemperatureSensorParameters parameters_;
  RandomStream stream_;
};

}  // namespace beamgyro::internal
