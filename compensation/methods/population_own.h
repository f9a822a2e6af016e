// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Returns the modes of a population and behind them those of its own parts:
/// the columns of a root of their covariance.
Eigen::MatrixXd all_modes(const Population& population);

/// Returns the own part of each curve that predicts the devices of a population
/// best, or nothing where none predicts better than the modes alone, and for
/// fewer than kLeastForOwnParts devices.
///
/// Each device is predicted from all others at 3, 5 and 7 even soaks of its own
/// curves (left_out_device()). The score is the mean logarithm of the normal
/// density of its bias at all temperatures of the grid. Lengths and deviations
/// are tried from a table, one curve after the other.
std::vector<OwnPart> learned_own_parts(const Population& population);

constexpr int kLeastForOwnParts = 10;

}  // namespace beamgyro::internal
