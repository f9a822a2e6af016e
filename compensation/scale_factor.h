// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dataset/recording.h"

namespace beamgyro {

constexpr double kSmallRate = 2.0;           // [deg/s]
constexpr double kLeastRateDeparture = 0.1;  // [deg/s]
constexpr double kTableRate = 5.0;           // [deg/s], of a rate table
constexpr double kCancelledBelow = 0.5;      // [-], scale factor retained
constexpr double kSettlingTime = 1.0;        // [s]
constexpr double kEveryRate = std::numeric_limits<double>::infinity();

/// |scale factor - 1| allowed.
struct ScaleFactorTolerance {
  double every_rate = 1e-3;   // [-]
  double small_rates = 1e-2;  // [-], within kSmallRate

  double at(double rate) const {  // [deg/s]
    return std::abs(rate) <= kSmallRate ? small_rates : every_rate;
  }
};

/// Sums from which slopes over the true rate Omega are made, of one run or, by
/// addition, of many. Within each temperature plateau, w is what the measured
/// temperature leaves of the rate and v what temperature and drift leave of it
/// (without_temperature(), without_drift()). Σ w y / Σ w Omega then is the
/// slope of y over Omega with a bias and a temperature slope of its own for
/// every plateau, Σ v y / Σ v Omega moreover with a smooth drift: what drifts,
/// or what a compensator takes off a drift, is not mistaken for scale factor.
struct SlopeSums {
  double compensated = 0.0;                // [(deg/s)^2], Σ w compensated_rate
  double raw = 0.0;                        // [(deg/s)^2], Σ w rate
  double truth = 0.0;                      // [(deg/s)^2], Σ w Omega
  double compensated_without_drift = 0.0;  // [(deg/s)^2], Σ v compensated_rate
  double raw_without_drift = 0.0;          // [(deg/s)^2], Σ v rate
  double truth_without_drift = 0.0;        // [(deg/s)^2], Σ v Omega
  double largest_departure = 0.0;          // [deg/s], max |w|
  std::size_t samples = 0;

  SlopeSums& operator+=(const SlopeSums& other);
};

/// Over powered, unsaturated samples with |true_rate| <= `largest_rate` that
/// have been so for kSettlingTime (an output filter still remembers a larger
/// rate). Throws std::invalid_argument naming a column that is missing, or when
/// `compensated` has not one entry per time.
SlopeSums slope_sums(const Recording& recording,
                     std::span<const double> compensated,
                     double largest_rate = kEveryRate);

/// What one temperature plateau says of the scale factor.
struct PlateauSlope {
  double temperature;  // [degC], mean
  double raw;          // [(deg/s)^2], Σ v rate
  double truth;        // [(deg/s)^2], Σ v Omega
  double compensated;  // [(deg/s)^2], Σ v compensated_rate
};

/// Of every plateau whose true rate departs by `least_departure` [deg/s].
/// Samples within kSettlingTime after a step of the rate by more than that are
/// left out, unless nothing is left then: the output lags behind the step.
/// `compensated` may be empty: then it is the rate.
std::vector<PlateauSlope> plateau_slopes(
    const Recording& recording, double least_departure,
    std::span<const double> compensated = {});

struct ScaleFactor {
  double retained;   // [-], Σ v compensated_rate / Σ v rate
  double slope;      // [-], of compensated_rate over true_rate, absolute
  double raw_slope;  // [-], of rate over true_rate
  double largest_departure;  // [deg/s], of the true rate: SlopeSums
};

/// Nothing when the true rate nowhere departs by kLeastRateDeparture: a slope
/// over a rate that does not vary is noise.
std::optional<ScaleFactor> scale_factor(const SlopeSums& sums);

}  // namespace beamgyro
