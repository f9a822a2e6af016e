// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "validation/result/validation_result.h"

namespace beamgyro {

/// Returns a result as `validate --json` writes it
/// (docs/reference/validation_result.md). A figure that is missing or not
/// finite is null. The same result gives the same bytes.
nlohmann::ordered_json to_json(const ValidationResult& result);

}  // namespace beamgyro
