// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compensation/allan_deviation.h"

namespace beamgyro {

struct Estimate {
  double value;
  double uncertainty;  // 1-sigma
};

/// A tau that the fit leaves out.
struct LeftOutTau {
  double tau;  // [s]
  double
      ratio;  // [-], its deviation over that of the fit; NaN if that has none
};

/// What an Allan curve of rates in u shows, with u = deg/s or any other unit.
/// A term that the curve does not show is missing.
struct NoiseCoefficients {
  std::optional<Estimate> angle_quantisation;  // Q [u s]
  std::optional<Estimate> angle_random_walk;   // N [u sqrt(s)]
  std::optional<Estimate> bias_instability;    // B [u]
  std::optional<Estimate> rate_random_walk;    // K [u/sqrt(s)]
  std::optional<Estimate> rate_ramp;           // R [u/s]
  // Of the one pole that would limit the band of N as the curve shows [s].
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
/// autocovariance r(u), has N^2/tau - 3 M/tau^2 at taus beyond its memory,
/// M = integral of u r(u): where that outweighs Q the first term is below zero,
/// and `band_limit` 2 M/N^2 is told in place of Q.
///
/// A deviation has the relative variance u^2 + f^2: u is chance
/// (relative_uncertainty()), f what the terms do not describe, the same at
/// every tau, of the most likely size. Without f the shortest taus, whose u is
/// 1e-3 and less, would decide alone. Of all sets of terms, and of all taus
/// from which the fit may start, those are kept that minimise
///
///   sum over taus fitted of r^2/(u^2 + f^2) + sum over all of ln(u^2 + f^2)
///     + 3^2 (terms + taus left out),   r = ln(deviation / fit):
///
/// a term must be seen at three standard errors, and so must a defect of a tau
/// that is left out, at most half of them. Taus with an uncertainty above 25 %
/// (fewer than nine clusters) are not fitted, and there are two taus more than
/// terms.
///
/// Throws std::invalid_argument with fewer than five taus to fit, or a
/// deviation that is not finite.
NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points);

/// Whether there are enough points for noise_coefficients().
bool has_noise_coefficients(const std::vector<AllanPoint>& points);

/// A coefficient in seconds and in hours, with its units: of rates in "deg/s"
/// 0.01 deg/sqrt(s) and 0.6 deg/sqrt(h), of another unit U 0.01 U sqrt(s) and
/// U sqrt(h).
struct CoefficientReport {
  char symbol;       // Q, N, B, K or R
  const char* name;  // "angle random walk"
  std::optional<Estimate> per_second;
  double hours_per_second_unit;  // value in hours over that in seconds
  std::string unit_per_second, unit_per_hour;
};
std::vector<CoefficientReport> reports(const NoiseCoefficients& coefficients,
                                       const std::string& unit);

/// {"N": {"per_second": {"value", "unit"}, "per_hour": {...},
/// "relative_uncertainty"}, ..., "lowest", "fit"}
/// (docs/reference/allan_deviation.md).
nlohmann::ordered_json to_json(const NoiseCoefficients& coefficients,
                               const std::string& unit);

}  // namespace beamgyro
