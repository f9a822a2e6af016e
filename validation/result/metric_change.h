// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "validation/result/device_evidence.h"
#include "validation/result/judgement.h"
#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns "same", "better", "worse" or "unknown".
std::string_view change_name(Change change);

/// Compares two values of a metric. The 95 % interval of the difference is that
/// of independent values: towards each other, the root of the sum of squares of
/// their parts. Beyond it, the value with the smaller shortfall_of() is the
/// better one. A value without an interval counts as exact beside one that has
/// one; without any interval another value is kUnknown.
MetricChange change_of(const Metric& metric, const Estimate& own,
                       const Estimate& other);

/// Judges a second compensator on the runs of `found`, whose answers are the
/// same afterwards, and compares the first result with it. Noise and turn-on
/// offset are in both, so the drift that they leave is compared run by run
/// (paired_residual()); other metrics as change_of() does. The sentence says
/// which is better: the one that passes where the other does not, else the one
/// that leaves less. `answering` gives the answers to the runs: `other` itself,
/// or what stands before it until it is ready.
SideBySide side_by_side(const JudgedBy& other,
                        const TestedCompensator& answering,
                        const std::string& name, const ValidationResult& own,
                        DeviceEvidence& found, std::size_t threads);

}  // namespace beamgyro::internal
