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
  double cubic_rms = 0.0;     // [deg/s], of the cubic the compensator claims
  double constant_rms = 0.0;  // [deg/s], of a constant fitted to the run itself
  Verdict verdict = Verdict::kNotFinite;
  bool passed = false;
  std::size_t clamped = 0;  // samples
  bool in_sample = false;   // training used the device, was_used_in_training()
  std::vector<std::string> worse_than = {};  // better_fits()
  std::vector<std::string> not_tested = {};  // ReplayedScaleFactor::untested
};

/// Every run validated by itself, one in memory at a time. Throws
/// std::invalid_argument without runs and as validate().
std::vector<DeviceScore> score_devices(const Compensator& compensator,
                                       const RunSource& runs,
                                       const Specification& specification = {});

/// Median and worst residual, raw rate and the compensator's cubic over the
/// devices of each run, how many passed, and how many leave more than a
/// constant fitted to the run.
std::string device_table(const std::vector<DeviceScore>& scores);

/// What the scores do not tell by themselves: temperatures outside those of the
/// training, devices that training used.
std::vector<std::string> warnings_of(const Compensator& compensator,
                                     const RunSource& runs,
                                     const std::vector<DeviceScore>& scores);

nlohmann::ordered_json to_json(const std::vector<DeviceScore>& scores);

}  // namespace beamgyro
