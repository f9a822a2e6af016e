// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "compensation/uncertainty/bias_sigma.h"

namespace beamgyro::internal {

/// Share of residuals within the interval that is told of a calibrated sigma.
constexpr double kSigmaLevel = 0.9;

/// Fewest groups with a quantile at kSigmaLevel: n / (n + 1) reaches it.
constexpr int kLeastConformalGroups = 9;

// A row is on a ramp from this smoothed temperature rate on, and in the warm-up
// while exp(-t / tau_on) is above that share.
constexpr double kRampRate = 0.1 / 60.0;  // [K/s]
constexpr double kWarmUpShare = 0.05;     // [-], of three time constants

/// Residuals that sigma is calibrated on, one per row. Rows of a group share
/// slow noise and the turn-on offset; groups are exchangeable with what is to
/// come.
struct ResidualRows {
  Eigen::ArrayXd temperature;       // [degC], measured
  Eigen::ArrayXd residual;          // [deg/s]
  Eigen::ArrayXd since_power_on;    // exp(-t / kSigmaTimeConstant)
  Eigen::ArrayXd temperature_rate;  // [K/s], smoothed
  Eigen::ArrayXi group;
  std::string by;  // kind of group
  // [K], over which the residuals of a group forget themselves; infinite where
  // a group is one draw, as a device of a set is
  double correlation = std::numeric_limits<double>::infinity();

  Eigen::Index size() const { return residual.size(); }
};

using RowMask = Eigen::Array<bool, Eigen::Dynamic, 1>;

RowMask soak_rows(const ResidualRows& rows);     // neither of the others
RowMask ramp_rows(const ResidualRows& rows);     // not in the warm-up
RowMask warm_up_rows(const ResidualRows& rows);  // on a ramp or not

/// Returns the number of different groups of the rows of `mask`.
int groups_among(const ResidualRows& rows, const RowMask& mask);

/// Returns the a >= 0 for which
///
///   z^2 = residual^2 / (others^2 + (a scale)^2)
///
/// of the rows of `mask` is 1 on average, over groups of equal weight: sigma is
/// then a standard deviation, whatever the distribution. It is 0 where the
/// others are as large already. With fewer than kLeastConformalGroups it is
/// widened by Student's t over the normal quantile of kSigmaLevel, with a
/// degree of freedom for each rows.correlation that a group spans, and one or
/// more for each group. Throws std::invalid_argument when no row is in `mask`.
double mean_square_amplitude(const ResidualRows& rows, const RowMask& mask,
                             const Eigen::ArrayXd& others,
                             const Eigen::ArrayXd& scale);

/// Returns the q for which |residual| <= q sigma holds of a new group's rows
/// with probability kSigmaLevel on average: the quantile, over groups of equal
/// weight and one more group beyond all, of |residual| / sigma (split conformal
/// prediction with pooled groups). It is 1.645 for normal residuals. Returns 0
/// with fewer than kLeastConformalGroups.
double conformal_half_width(const ResidualRows& rows,
                            const Eigen::ArrayXd& sigma);

/// Calibrates the factor on the rows of soaks, then a_rate on those of ramps,
/// then a_on on those of warm-ups, and describes it in `calibration`. Without
/// rows of soaks the factor is calibrated on all, and a_rate is 0: s(T) is then
/// that of ramps. A term without rows of its own is absent.
void calibrate(BiasSigma& sigma, const ResidualRows& rows);

/// Calibrates a_rate and a_on alone.
void calibrate_terms(BiasSigma& sigma, const ResidualRows& rows);

}  // namespace beamgyro::internal
