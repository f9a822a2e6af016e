// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// The least span of runs [K] over which a correction can be told from none.
constexpr double kLeastSpanOfRuns = 10.0;

/// Returns the span of the measured temperatures of the runs [K], 0 where they
/// have none.
double temperature_span(const Evidence& evidence);

/// Returns a sentence on a compensator whose answers, over runs that span
/// kLeastSpanOfRuns or more, are the recorded rate or that rate less one
/// constant; empty for any other. Compared are means over the blocks of
/// score_blocks(), of all runs. A change counts as nothing below 1e-4 deg/s, or
/// below a hundredth of the standard deviation of the recorded rate's error
/// where that is less.
std::string words_of_no_effect(const Evidence& before, const Evidence& after);

}  // namespace beamgyro::internal
