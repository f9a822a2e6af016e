// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/device.h"

namespace beamgyro::internal {

/// What the user of a device sees of it at rest, without noise.
struct RestCurve {
  std::vector<double> time;         // [s]
  std::vector<double> temperature;  // [degC], of the sensor
  std::vector<double> bias;         // [deg/s]
};

/// Returns the time after power-on in still air at `ambient` [degC]: an hour in
/// steps of 1 s, or ten hours in steps of 10 s where the sensor still moves by
/// a fiftieth in the last tenth of the first. Adds the warnings of the run.
/// Throws as simulate().
RestCurve warm_up_run(const Device& device, double ambient,
                      std::vector<std::string>& warnings);

/// Returns the ends of soaks of `hold` [s] or longer, from the lowest to the
/// highest temperature of the chamber [degC] in steps of 5 K or less. Adds the
/// warnings of the run. Throws as simulate().
RestCurve swept_soaks(const Device& device, std::pair<double, double> range,
                      double hold, std::vector<std::string>& warnings);

}  // namespace beamgyro::internal
