// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns a result as `validate --json` writes it
/// (docs/reference/validation_result.md). A figure that is missing or not
/// finite is null. The same result gives the same bytes.
nlohmann::ordered_json to_json(const ValidationResult& result);

/// Returns the object "sigma" of it.
nlohmann::ordered_json sigma_json(const SigmaReport& report);

/// Returns the array "metrics" of it.
nlohmann::ordered_json metrics_json(const std::vector<MetricResult>& metrics,
                                    const std::vector<DecidedLimit>& limits);

}  // namespace beamgyro::internal
