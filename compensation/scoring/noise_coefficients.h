// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compensation/scoring/allan_deviation.h"

namespace beamgyro::internal {

struct CoefficientEstimate {
  double value;
  double uncertainty;             // 1-sigma
  ConfidenceInterval interval{};  // of 95 %
};

/// A tau that the fit does not use.
struct LeftOutTau {
  double tau;  // [s]
  double
      ratio;  // [-], its deviation over that of the fit; NaN if that has none
};

/// Noise coefficients of an Allan curve of rates in the unit u (deg/s or any
/// other). A term that the curve does not show is missing.
struct NoiseCoefficients {
  std::optional<CoefficientEstimate> angle_quantisation;  // Q [u s]
  std::optional<CoefficientEstimate> angle_random_walk;   // N [u sqrt(s)]
  std::optional<CoefficientEstimate> bias_instability;    // B [u]
  std::optional<CoefficientEstimate> rate_random_walk;    // K [u/sqrt(s)]
  std::optional<CoefficientEstimate> rate_ramp;           // R [u/s]
  // Time constant [s] of the one pole that would limit the band of N as the
  // curve does.
  std::optional<double> band_limit;
  AllanPoint lowest{};               // of the curve
  bool still_falling = false;        // the lowest is at the longest tau
  std::vector<double> taus;          // [s], fitted to
  std::vector<LeftOutTau> left_out;  // shorter ones
  double misfit = 0.0;  // [-], 1-sigma of a deviation beyond chance
};

/// The terms of IEEE 952 in
///
///   sigma^2 = 3 Q^2/tau^2 + N^2/tau + (2 ln 2 / pi) B^2 + K^2 tau/3
///             + R^2 tau^2/2,
///
/// fitted to the squared deviations. White noise of a limited band, with the
/// autocovariance r(u), has N^2/tau - 3 M/tau^2 at taus beyond its memory, M =
/// integral of u r(u): where that outweighs Q the first term is below zero, and
/// `band_limit` 2 M/N^2 is returned in place of Q.
///
/// A deviation has the relative variance u^2 + f^2. u is its statistical
/// uncertainty (relative_uncertainty()). f is the misfit of the terms, the same
/// at every tau, of the most likely size; without it the shortest taus, whose u
/// is 1e-3 and less, would decide alone. Of all sets of terms, and of all taus
/// at which the fit may start, it takes those that minimise
///
///   sum over taus fitted of r^2/(u^2 + f^2) + sum over all of ln(u^2 + f^2)
///     + 3^2 (terms + taus left out),   r = ln(deviation / fit):
///
/// So a term must differ from 0 by three standard errors, and a tau that is
/// left out must deviate by as much; at most half of the taus are left out.
///
/// The uncertainty of a coefficient is that of a weighted fit to deviations
/// that are not independent: the covariances of the squared deviations are
/// those of overlapping differences of noise with the terms found
/// (difference_covariance.h), with 4 f^2 added for each deviation. The interval
/// is of chi-squared with the degrees of freedom of that uncertainty.
///
/// Taus with an uncertainty above 25 % (fewer than nine clusters) are not
/// fitted, and there are at least two taus more than terms.
///
/// Throws std::invalid_argument with fewer than five taus to fit, or a
/// deviation that is not finite.
NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points);

/// Returns whether there are enough points for noise_coefficients().
bool has_noise_coefficients(const std::vector<AllanPoint>& points);

/// A coefficient in seconds and in hours, with its units: deg/sqrt(s) and
/// deg/sqrt(h) for rates in "deg/s", U sqrt(s) and U sqrt(h) for another unit
/// U.
struct CoefficientReport {
  char symbol;       // Q, N, B, K or R
  const char* name;  // "angle random walk"
  std::optional<CoefficientEstimate> per_second;
  double hours_per_second_unit;  // value in hours over that in seconds
  std::string unit_per_second, unit_per_hour;
};
std::vector<CoefficientReport> reports(const NoiseCoefficients& coefficients,
                                       const std::string& unit);

/// {"N": {"per_second": {"value", "interval", "unit"}, "per_hour": {...},
/// "relative_uncertainty"}, ..., "lowest", "fit"}
/// (docs/reference/allan_deviation.md).
nlohmann::ordered_json to_json(const NoiseCoefficients& coefficients,
                               const std::string& unit);

}  // namespace beamgyro::internal
