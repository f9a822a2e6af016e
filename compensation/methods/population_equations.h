// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Values H c + noise = y that points of a device show of its c, the numbers in
/// all_modes(), each over its noise, so that this has unit variance.
struct PointEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd y;
};

constexpr double kPointReach = 0.5;  // [K]

/// Returns the equations of all points of the rows, first of the bias, then of
/// each channel of `inputs`, whose first one is the temperature. A point is the
/// mean of the rows within kPointWidth of each other. Rows that lie beyond the
/// temperatures of the population by more than kPointReach are left out: their
/// clamped temperature is not theirs. Throws
/// std::invalid_argument for an input that the population does not know.
PointEquations point_equations(const Population& population,
                               const std::vector<Input>& inputs,
                               const TrainingRows& rows,
                               const PointNoise& noise);

}  // namespace beamgyro::internal
