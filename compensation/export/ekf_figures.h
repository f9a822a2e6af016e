// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "compensation/compensator/compensator.h"
#include "compensation/export/rest_noise.h"
#include "compensation/uncertainty/bias_process.h"

namespace beamgyro::internal {

/// What the user of a navigation filter chooses.
struct EkfSettings {
  // [degC] at power-on; without it any of the temperatures that sigma was
  // computed for, equally likely.
  std::optional<double> temperature = {};
  double temperature_rate = 1.0 / 60.0;   // [K/s] that the bias noise is for
  double correlation = kBiasCorrelation;  // [K], L of (U.1)
};

/// What navigation filters ask for, of one axis. With sigma(T, e, r) of the
/// compensator, e = exp(-t / tau_on) and <> the mean over the temperatures of
/// its curve, or the value at the temperature chosen:
///
///   sigma_0^2 = <sigma(T, 1, 0)^2>                                    (E.1)
///   Q(r) = K^2 + 2 <sigma(T, 0, 0)^2> |r| / L + 2 s_r^2 / tau_rate    (E.2)
///   s_r^2 = <sigma(T, 0, r)^2> - <sigma(T, 0, 0)^2>
///   t_T = L / |r|                                                     (E.3)
///
/// (E.2) is the rate at which the variance of the bias grows, of a random walk:
/// K of the rest, the walk (U.2) over temperature, and the part of sigma that
/// comes with the temperature rate as a first-order Gauss-Markov process.
struct EkfFigures {
  double noise_density;                 // N [deg/s/sqrt(Hz)]
  double power_on_sigma;                // sigma_0 [deg/s]
  double temperature_sigma;             // sqrt(<sigma(T, 0, 0)^2>) [deg/s]
  double base_walk;                     // K [deg/s/sqrt(s)]
  double walk_per_root_kelvin;          // sqrt(2 / L) temperature_sigma
  double bias_walk;                     // sqrt(Q(r)) [deg/s/sqrt(s)]
  double correlation_time;              // t_T [s]; infinite for r = 0
  std::optional<double> power_on_time;  // tau_on [s]
};

/// Returns the figures of a compensator that states a sigma.
EkfFigures ekf_figures(const Compensator& compensator, const RestNoise& noise,
                       const EkfSettings& settings);

}  // namespace beamgyro::internal
