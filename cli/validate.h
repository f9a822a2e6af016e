// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/process_limits.h"
#include "compensation/rows/set_runs.h"

namespace beamgyro::internal {

/// Exit status of a validation that ran and was not passed.
constexpr int kNotPassed = 3;

/// The words of `validate`.
struct ValidateArguments {
  std::string compensator, json, report, figures, bundle, check;
  std::vector<std::string> runs;      // recordings, or one set
  std::vector<std::string> device;    // a device file, or numbers of a set
  std::vector<std::string> set_runs;  // names, of a set
  std::optional<double> full_scale;   // [deg/s]
  std::optional<std::string> qualification, campaign, specification, workbench;
  std::optional<long> devices, jobs;
  LimitArguments limits;
  bool list_metrics = false;
};

/// Returns what is chosen from a set: the test devices, or those named.
SetSelection set_selection(const ValidateArguments& arguments);

/// Judges a compensator by every metric, check and limit, on a simulated
/// device, on recordings or on the devices of a set.
int validate_by_specification(const ValidateArguments& arguments);

/// Makes the result of a bundle again. The status is 0 when every byte is the
/// same, and 1 when not.
int check_bundle(const ValidateArguments& arguments);

}  // namespace beamgyro::internal
