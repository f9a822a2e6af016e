// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/process_limits.h"
#include "include/beamgyro/validate.h"

namespace beamgyro::internal {

/// Exit status of a validation that ran and was not passed.
constexpr int kNotPassed = 3;

/// The words of `validate`.
struct ValidateArguments {
  std::string compensator, json, junit, trained, report, figures, bundle, check;
  std::vector<std::filesystem::path> runs;  // recordings, or one set
  std::vector<std::string> device;  // a device file, or numbers of a set
  ValidationOptions options;        // without these
  LimitArguments limits;
  bool list_metrics = false, all_metrics = false, lines = false;
  bool runs_code = false;
};

/// Returns what the words ask for. Throws std::invalid_argument for words that
/// contradict each other.
ValidationOptions validation_options(const ValidateArguments& arguments);

/// Judges a compensator on a simulated device, on recordings or on the devices
/// of a set.
int judge_compensator(const ValidateArguments& arguments);

/// Makes the result of a bundle again. The status is 0 when every byte is the
/// same, and 1 when not.
int check_bundle(const ValidateArguments& arguments);

}  // namespace beamgyro::internal
