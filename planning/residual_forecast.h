// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "planning/soak_model.h"

namespace beamgyro {

/// The rms over the range [deg/s] of what compensation leaves of the bias: its
/// quantiles over devices of the population.
struct ResidualForecast {
  double median = 0.0, p90 = 0.0, p95 = 0.0;
};

/// Where a forecast takes its devices from.
enum class ForecastBasis {
  kDevices,   // each device of the population, predicted by all others
  kGaussian,  // draws from the Gaussian process
};

/// The basis that a population allows: its devices if it stores the
/// coefficients of three or more.
ForecastBasis forecast_basis(const Population& population);

/// Forecasts the residual of devices that are adapted from soaks at these
/// temperatures of the chamber, as adapted_bias() does it.
///
/// Of devices: device d with coefficients c among n is predicted from the
/// other n - 1. In the coordinates of c these have the mean -c / (n - 1) and
/// the covariance
///
///   P_d = ((n - 1) I - n / (n - 1) c c^T) / (n - 2),
///
/// the soaks show H x + noise, x = n / (n - 1) c, and the residual is that of
/// e = x - P_d H^T (H P_d H^T + I)^-1 (H x + noise).
///
/// Of the Gaussian process: rms^2 = sum of lambda_k z_k^2 with the eigenvalues
/// of the posterior covariance over the range and z ~ N(0, 1).
///
/// Noise and z come from counter-based streams: the forecast of the same soaks
/// is always the same.
ResidualForecast forecast_residual(const SoakModel& model,
                                   const std::vector<double>& soaks);

}  // namespace beamgyro
