// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace beamgyro::internal {

/// Returns the page of a report (HTML): page.html with `result` and Chart.js in
/// it, which loads nothing else. `result` is what `validate --json` writes
/// (docs/reference/validation_result.md). The page shows what is there and
/// passes over what is missing; text in `result` is shown as text, whatever it
/// holds. The same result gives the same bytes.
std::string page_of(const nlohmann::ordered_json& result);

}  // namespace beamgyro::internal
