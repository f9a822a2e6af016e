// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "compensation/scoring/validation.h"

namespace beamgyro::internal {

/// Scores of a compensator on one device in one run.
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

/// Validates every run by itself, with one run in memory at a time. Throws
/// std::invalid_argument without runs and as validate().
std::vector<DeviceScore> score_devices(const Compensator& compensator,
                                       const RunSource& runs,
                                       const Specification& specification = {});

/// Returns a table for each run: median and worst residual over the devices,
/// the same for the raw rate and for the cubic of the compensator, the number
/// of devices that passed, and the number on which the compensator is worse
/// than a constant fitted to the run.
std::string device_table(const std::vector<DeviceScore>& scores);

/// Returns warnings about temperatures outside those of training and about
/// devices that training used.
std::vector<std::string> warnings_of(const Compensator& compensator,
                                     const RunSource& runs,
                                     const std::vector<DeviceScore>& scores);

nlohmann::ordered_json to_json(const std::vector<DeviceScore>& scores);

}  // namespace beamgyro::internal
