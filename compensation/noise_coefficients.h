// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compensation/allan_deviation.h"

namespace beamgyro {

/// Names and units of the field for what an Allan curve in deg/s shows. One
/// that the curve does not show is missing.
struct NoiseCoefficients {
  std::optional<double> angle_random_walk;   // N [deg/sqrt(h)] = 60 deg/sqrt(s)
  std::optional<double> bias_instability;    // B [deg/h] = 3600 deg/s
  std::optional<double> rate_random_walk;    // K [deg/h/sqrt(h)]
  std::optional<double> angle_quantisation;  // Q [deg]
  std::optional<double> rate_ramp;           // R [deg/h/h]
};

/// N, K, Q and R are the lines of IEEE 952 in
///
///   sigma^2 = 3 Q^2/tau^2 + N^2/tau + (2 ln 2 / pi) B^2 + K^2 tau/3
///             + R^2 tau^2/2
///
/// fitted to the squared deviations, each weighted by its uncertainty, with no
/// term below zero; a term under three times its own uncertainty is missing. B
/// is the lowest deviation over sqrt(2 ln 2 / pi) = 0.6643, missing when the
/// curve still falls at its longest tau. Points with fewer than nine clusters
/// (uncertainty 25 %) are not used. Throws
/// std::invalid_argument with fewer than five such points or a deviation that
/// is not finite.
NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points);

/// Whether there are enough points for noise_coefficients().
bool has_noise_coefficients(const std::vector<AllanPoint>& points);

/// One line each, with unit: "angle random walk N   0.600 deg/sqrt(h)".
std::string table(const NoiseCoefficients& coefficients);

}  // namespace beamgyro
