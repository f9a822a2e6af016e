// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Returns whether the bias moves more than slow noise would: its variance is
/// above n s^2 / 20, with n rows and s^2 half the mean square second difference
/// within a cycle. White noise alone gives s^2 / 3, a random walk alone n s^2 /
/// 6. This serves for a single leg of temperature. There the temperature is a
/// function of time, like a random walk, and no group can be held out to
/// distinguish them.
bool moves_more_than_noise(const TrainingRows& rows);

}  // namespace beamgyro::internal
