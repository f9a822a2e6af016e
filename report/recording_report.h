// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Returns what a recording holds: its origin, its samples by their status, and
/// a line for each variable with unit, role and range. `path` is its name.
std::string recording_report(const std::string& path,
                             const Recording& recording);

}  // namespace beamgyro::internal
