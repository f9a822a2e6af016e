// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns the lines on another compensator on the same runs: which is better,
/// its verdict, and the metrics that differ beyond their interval; with `all`,
/// every metric.
std::string side_by_side_report(const SideBySide& other, bool all);

/// Returns the lines on an earlier result: what is worse, what is better and
/// how many metrics are the same; with `all`, every metric.
std::string earlier_report(const EarlierComparison& earlier, bool all);

}  // namespace beamgyro::internal
