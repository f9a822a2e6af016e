// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/inputs/input.h"
#include "compensation/methods/population.h"
#include "compensation/rows/training_rows.h"
#include "compensation/uncertainty/sigma_calibration.h"

namespace beamgyro::internal {

/// Returns the rows of devices that the population was not learned from, as
/// residuals of the spline through the soaks of each device itself: what lags
/// on ramps and in warm-ups. `rows` has their temperature, then the channels;
/// the last two columns are since_power_on and temperature_rate. A device whose
/// soaks determine no spline is left out, with a line in `remarks`.
ResidualRows own_curve_residuals(const TrainingRows& rows, double grid_K,
                                 std::vector<std::string>& remarks);

/// Returns the calibration of devices adapted from `population`, on devices it
/// was not learned from. Each is adapted from few soaks of its `soaks`, evenly
/// spaced, and predicted at the others. The factor makes the mean square of
/// what is missed there, together with the noise that AdaptedBias tells of its
/// points, that of the posterior deviation: soaks of one run share their
/// turn-on offset, so their rows do not show this noise. a_rate and a_on are
/// those of `lagging`, own_curve_residuals(), beyond what soaks leave of the
/// same curves. Without rows to predict, nothing.
std::optional<AdaptationSigma> adaptation_sigma(
    const Population& population, const std::vector<Input>& inputs,
    const TrainingRows& soaks, const ResidualRows& lagging);

/// Returns sigma over temperature of a device adapted with `deviation`, on the
/// grid of the population: k^2 s^2 = k^2 deviation^2 + 2 noise^2. The turn-on
/// offset and slow noise of `noise` are those of the run adapted to and, once
/// more, of the run that is compensated.
BiasSigma adapted_sigma(const Population& population,
                        const Eigen::ArrayXd& deviation,
                        const PointNoise& noise);

/// Returns sigma over temperature of the mean of the population: its spread.
BiasSigma population_sigma(const Population& population);

}  // namespace beamgyro::internal
