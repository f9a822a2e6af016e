// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "api/validator.h"

namespace beamgyro::internal {

/// A validation as files show it.
struct ValidationTexts {
  std::string json;         // what --json writes and the page shows
  std::string text;         // the verdict and what decided it
  std::string all_metrics;  // the same with every metric
  std::string page;         // HTML
};
ValidationTexts texts_of(const CompletedValidation& validation);

}  // namespace beamgyro::internal
