// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns a result for a terminal, in lines of at most 100 columns: the
/// verdict in words; a table of the metrics before and after compensation and
/// of the baselines; one line for each limit with value, interval, limit and
/// margin; the checks; and the yield of a population.
std::string verdict_report(const ValidationResult& result);

}  // namespace beamgyro::internal
