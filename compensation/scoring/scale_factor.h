// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

constexpr double kSmallRate = 2.0;           // [deg/s]
constexpr double kLeastRateDeparture = 0.1;  // [deg/s]
constexpr double kTableRate = 5.0;           // [deg/s], of a rate table
constexpr double kCancelledBelow = 0.5;      // [-], scale factor retained
constexpr double kSettlingTime = 1.0;        // [s]
constexpr double kEveryRate = std::numeric_limits<double>::infinity();

/// Sums for slopes over the true rate Omega, of one run or, by addition, of
/// many. v is the rate of a temperature plateau without its part along the
/// measured temperature and without drift (without_drift()). Then
/// Σ v y / Σ v Omega is the slope of y over Omega with a separate bias,
/// temperature slope and smooth drift for every plateau. So neither a drift nor
/// its compensation is mistaken for scale factor.
struct SlopeSums {
  double compensated = 0.0;  // [(deg/s)^2], Σ v compensated_rate
  double raw = 0.0;          // [(deg/s)^2], Σ v rate
  double truth = 0.0;        // [(deg/s)^2], Σ v Omega
  double power = 0.0;        // [(deg/s)^2], Σ (Omega - its mean over a run)^2
  // [deg/s], largest magnitude of the true rate without_temperature()
  double largest_departure = 0.0;
  std::size_t samples = 0;

  SlopeSums& operator+=(const SlopeSums& other);

  /// Returns the sums of one run times min(power / truth, 100), so that the run
  /// counts among others by the power of its true rate. What is left in v
  /// depends on where the measured temperature divides the plateaus, and so on
  /// its noise.
  SlopeSums by_power() const;
};

/// Sums over powered, unsaturated samples with |true_rate| <= `largest_rate`
/// for at least kSettlingTime, because the output filter still contains an
/// earlier larger rate. Throws std::invalid_argument naming a column that is
/// missing, or when `compensated` has not one entry per time.
SlopeSums slope_sums(const Recording& recording,
                     std::span<const double> compensated,
                     double largest_rate = kEveryRate);

/// Slopes on one temperature plateau.
struct PlateauSlope {
  double temperature;  // [degC], mean
  double raw;          // [(deg/s)^2], Σ v rate
  double truth;        // [(deg/s)^2], Σ v Omega
  double compensated;  // [(deg/s)^2], Σ v compensated_rate
};

/// Returns the slopes of every plateau whose true rate departs by
/// `least_departure` [deg/s]. Samples within kSettlingTime after a larger step
/// of the rate are left out, because the output lags behind, unless no sample
/// would remain. An empty `compensated` means the rate itself.
std::vector<PlateauSlope> plateau_slopes(
    const Recording& recording, double least_departure,
    std::span<const double> compensated = {});

constexpr double kHeldWithin = 0.5;             // [deg/s], of a held rate
constexpr std::size_t kLeastHeldSamples = 20;   // of a slope
constexpr double kMostSlopeUncertainty = 2e-3;  // [-]

/// A slope over rates that were held.
struct HeldSlope {
  PlateauSlope slope;
  // Half of the 95 % interval of raw / truth [-], from what the slope, a drift
  // and the temperature leave of the rate.
  double uncertainty;
};

/// Returns the slopes of every plateau over the samples of held rates: since
/// kSettlingTime the true rate has stayed within kHeldWithin of one value. A
/// slope needs kLeastHeldSamples, rates that depart by kTableRate, and an
/// uncertainty of at most kMostSlopeUncertainty; so a random rate that keeps
/// still by chance has none.
std::vector<HeldSlope> held_slopes(const Recording& recording,
                                   std::span<const double> compensated = {});

/// Returns the scale factor that the compensated rate retains of the raw one
/// [-], Σ v compensated_rate / Σ v rate. Returns nothing when the true rate
/// nowhere departs by kLeastRateDeparture, because a slope over a constant rate
/// is noise.
std::optional<double> share_retained(const SlopeSums& sums);

}  // namespace beamgyro::internal
