// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Share of the devices of a population that count as its own [-]. The others
/// are as far from the rest as a foreign device may be.
constexpr double kOwnShare = 0.96;

/// How far points of a device are from what a population expects of them.
struct Membership {
  double distance = 0.0;     // chi-squared [-]
  Eigen::Index values = 0;   // that it is the sum of
  double threshold = 0.0;    // [-], that kOwnShare of new devices do not exceed
  Eigen::Index devices = 0;  // of the population that it was taken from

  bool is_foreign() const { return distance > threshold; }
};

/// What the beam may be warmer than the rows say, the same at all points [K],
/// 1-sigma: a lag that the rows correct for another ramp.
constexpr double kBeamTemperatureError = 0.5;

/// Compares a device with a population by the Mahalanobis distance of its
/// points y, with mu, H and R as of adapted_bias():
///
///   chi^2 = (y - mu)^T (H H^T + R)^-1 (y - mu).
///
/// To H a column is added for kBeamTemperatureError, with the slopes of the
/// device that the points show.
///
/// The threshold is that of the population's devices at the same points, each
/// held against all others (left_out_device()): a chi-squared distribution
/// would count too many of them as foreign, because a finite sample leaves out
/// some of what the next device is. Of N devices it is the one of rank
/// ceil(kOwnShare (N + 1)): a further device of the same kind exceeds it with
/// the probability 1 - kOwnShare, whatever the distribution (split conformal
/// prediction). Points of the devices are those of the curves that the
/// population was learned from, with drawn noise R of points (random stream
/// kMembershipStream of each device).
///
/// Nothing without rows, and where the population has the coefficients of too
/// few devices, fewer than 24.
std::optional<Membership> membership(const Population& population,
                                     const std::vector<Input>& inputs,
                                     const TrainingRows& rows,
                                     const PointNoise& noise);

}  // namespace beamgyro::internal
