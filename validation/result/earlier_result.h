// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// What a later result is compared with: a file of `validate --json`.
struct EarlierResult {
  std::string name;  // of the file, without its folder
  std::string verdict;
  std::map<std::string, Estimate> metrics;  // of the compensated rate
  // Whether they passed, by the name of the limit or check.
  std::map<std::string, bool> passed;
  std::vector<ResultFile> files;
};

/// Reads the text of a file called `path`. Metrics without a value are left
/// out. Throws std::invalid_argument with the file and the key for text that is
/// no result of a validation.
EarlierResult parse_earlier_result(const std::string& text,
                                   const std::string& path);

/// Compares a result with an earlier one and writes what is found into it.
/// Where a limit or check that passed does not pass any more, or a metric is
/// worse beyond the interval of the difference (change_of()), the verdict
/// becomes kFail, and the words begin with that. Limits are the same where
/// metric and reference are.
void compare_with(const EarlierResult& earlier, ValidationResult& result);

}  // namespace beamgyro::internal
