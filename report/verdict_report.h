// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns a result for a terminal, in lines of at most 100 columns: what each
/// run shows alone; a table of metrics before and after compensation and of the
/// baselines; the figures of a population, of the devices of a set or over
/// seeds; a line for each limit and check, and for each seed that does not
/// pass. Unless `all` is asked for, the table has the metrics with a limit and
/// the residual, and checks that passed share a line. The last lines are the
/// verdict with its reason, and the next step.
std::string verdict_report(const ValidationResult& result, bool all);

/// Returns a line for every metric: name, unit, clause, purposes and
/// definition, with tabs between.
std::string metric_list();

}  // namespace beamgyro::internal
