// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/training_rows.h"

namespace beamgyro {

/// Whether half or more of the temperatures are visited on two legs.
bool temperature_comes_back(const TrainingRows& rows);

/// Whether the bias moves more than slow noise would: its variance is above
/// n s^2 / 20, n rows, s^2 half the mean square second difference within a
/// cycle. White noise alone gives s^2 / 3, a random walk alone n s^2 / 6.
bool moves_more_than_noise(const TrainingRows& rows);

/// Whether temperature explains the bias, asked where too few groups can be
/// held out to tell. If the temperature comes back, the cubic leaves less than
/// half the variance: a walk does not come back with it. If not, temperature is
/// a function of time, as the walk is, and moves_more_than_noise() is all there
/// is to ask; it leans to the curve, which costs little where there is none.
bool temperature_shows(const TrainingRows& rows);

}  // namespace beamgyro
