// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns the lines on the metrics of another compensator on the same runs
/// that differ beyond their interval; with `all`, on every metric.
std::string side_by_side_report(const SideBySide& other, bool all);

/// Returns the lines on an earlier result: what is worse, what is better and
/// how many metrics are the same; with `all`, every metric.
std::string earlier_report(const EarlierComparison& earlier, bool all);

}  // namespace beamgyro::internal
