// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/population.h"
#include "planning/soak_model.h"

namespace beamgyro::internal {

/// A population on every kelvin from 0 to 40 degC with one channel: four smooth
/// modes that are steep in the cold, and coefficients of `devices` devices,
/// c = s g with normal numbers g, and for each device s = 1, or with
/// `heavy_tails` 0.3 or 1.7 in turn. Modes and mean are those of the curves.
Population small_population(int devices, bool heavy_tails = false);

/// A chamber that the sensor follows.
Eigen::ArrayXd same_temperature(const Eigen::ArrayXd& chamber);

/// The model of a population in such a chamber, over all of its range.
SoakModel model_of(const Population& population, bool bias_only = false);

}  // namespace beamgyro::internal
