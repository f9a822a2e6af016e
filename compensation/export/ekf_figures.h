// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/noise_coefficients.h"
#include "compensation/uncertainty/bias_process.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Noise of a compensated rate at rest, from its overlapping Allan deviation.
struct RestNoise {
  NoiseCoefficients coefficients;  // with N
  // K [deg/s/sqrt(s)]: of the coefficients, or the largest one that the curve
  // leaves room for: the least of the upper 95 % limits of sqrt(3 / tau) times
  // the deviation.
  double walk = 0.0;
  bool walk_is_bound = false;
  // Time constant [s] of the first-order Gauss-Markov process whose Allan
  // deviation peaks, at 1.893 time constants, in the middle of the flicker
  // floor; without B or K there is none.
  std::optional<double> flicker_time;
  double sample_rate = 0.0;  // [Hz]
  std::size_t samples = 0;
  double duration = 0.0;          // [s]
  double temperature_span = 0.0;  // [K], of the powered samples
};

/// Returns the noise that a compensator leaves of a recording at rest. Throws
/// std::invalid_argument
/// - as compensated_rate(), even_series() and noise_coefficients();
/// - when the true rate of the recording changes;
/// - when it is too short for coefficients, or shows no angle random walk.
RestNoise rest_noise(const FittedCompensator& compensator,
                     const Recording& rest);

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
EkfFigures ekf_figures(const FittedCompensator& compensator,
                       const RestNoise& noise, const EkfSettings& settings);

}  // namespace beamgyro::internal
