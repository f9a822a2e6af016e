// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compensation/compensator.h"
#include "compensation/run_source.h"
#include "compensation/validation.h"

namespace beamgyro {

/// What a compensator leaves of one device in one run.
struct DeviceScore {
  std::string device, run;
  double residual_rms = 0.0;  // [deg/s]
  double raw_rms = 0.0;       // [deg/s]
  double cubic_rms = 0.0;     // [deg/s], of the compensator's own baseline
  Verdict verdict = Verdict::kNotFinite;
  bool passed = false;
  std::size_t clamped = 0;  // samples
};

/// Every run validated by itself, one in memory at a time. Throws
/// std::invalid_argument without runs and as validate().
std::vector<DeviceScore> score_devices(const Compensator& compensator,
                                       const RunSource& runs);

/// Median and worst residual, raw rate and cubic over the devices of each run,
/// and how many passed.
std::string device_table(const std::vector<DeviceScore>& scores);

nlohmann::ordered_json to_json(const std::vector<DeviceScore>& scores);

}  // namespace beamgyro
