// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/training_rows.h"

namespace beamgyro {

/// Whether the bias moves more than slow noise would: its variance is above
/// n s^2 / 20, n rows, s^2 half the mean square second difference within a
/// cycle. White noise alone gives s^2 / 3, a random walk alone n s^2 / 6. Asked
/// of one leg of temperature, which is a function of time, as the walk is: no
/// group can be held out to tell one from the other.
bool moves_more_than_noise(const TrainingRows& rows);

}  // namespace beamgyro
