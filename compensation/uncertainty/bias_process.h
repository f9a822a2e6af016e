// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

/// Temperature over which the bias that a compensator leaves forgets itself
/// [K]: its correlation falls to 1/e. It is an assumption, which the metric
/// bias_filter_nis tests.
constexpr double kBiasCorrelation = 10.0;

/// How the bias b [deg/s] that a compensator leaves goes from one time to a
/// later one.
struct BiasStep {
  double carried;   // [-], c
  double variance;  // [(deg/s)^2], of w

  bool operator==(const BiasStep&) const = default;
};

/// Returns the step of a first-order Gauss-Markov process over temperature that
/// has the standard deviations sigma that a compensator states:
///
///   b' = c b + w,  c = rho sigma' / sigma,  var w = (1 - rho^2) sigma'^2,
///   rho = exp(-|dT| / L),                                             (U.1)
///
/// from `before` to `after` [deg/s], over a change dT [K] of the temperature
/// with the correlation L [K]. Then var b' = sigma'^2 if var b = sigma^2.
BiasStep bias_step(double before, double after, double temperature_change,
                   double correlation = kBiasCorrelation);

/// Returns the variance of b' - b of (U.1) per kelvin for small steps, as of a
/// random walk [(deg/s)^2/K]:
///
///   2 sigma^2 / L.                                                    (U.2)
double bias_walk_per_kelvin(double sigma,
                            double correlation = kBiasCorrelation);

}  // namespace beamgyro::internal
