// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/scoring/deviation_kind.h"
#include "compensation/scoring/noise_type.h"

namespace beamgyro::internal {

/// Returns the degrees of freedom of the chi-squared distribution that has the
/// relative variance 2/freedom of the square of a deviation of m samples, from
/// a record of `samples` rates of one type of noise:
///
///   freedom = C(0)^2 / <C^2>
///
/// where C are the covariances of the differences in it, over all pairs
/// (Greenhall and Riley, 35th PTTI, 2003; NIST SP 1065, 5.4). Of totdev it is
/// that of NIST SP 1065, table 7; of up to eight samples no more than that of
/// oadev, and of noise of angles, which the table lacks, that of the angles at
/// both ends, about which totdev reflects. Types that an order of differences
/// does not make stationary count as the nearest one that it does. At least
/// 1/2.
double equivalent_freedom(DeviationKind kind, NoiseType type, double m,
                          double samples);

/// The 95 % interval of a deviation: freedom deviation^2 / quantile of
/// chi-squared, between the quantiles of 0.975 and 0.025.
struct ConfidenceInterval {
  double low, high;
};
ConfidenceInterval confidence_interval(double deviation, double freedom);

/// Returns the square of totdev over that of adev as expected: 1 - a m/samples
/// with a = 0, 0.481, 0.750 for white noise, flicker and random walk
/// (NIST SP 1065, 5.11), -4/3 for noise of angles; 1 for the other deviations.
double expected_ratio(DeviationKind kind, NoiseType type, double m,
                      double samples);

}  // namespace beamgyro::internal
