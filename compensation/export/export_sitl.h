// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/export/export_parameters.h"

namespace beamgyro::internal {

/// The warm-up that ArduPilot's simulator (SITL) knows,
///
///   T(t) = T_end - (T_end - T_start) e^{-t/tau}                       (X.1)
///
/// fitted to a device's own.
struct WarmUpFit {
  double start = 0, end = 0;    // [degC]
  double time_constant = 0;     // tau [s]
  double rms = 0, largest = 0;  // [K], of the residual
};

/// Below this rise [K] from power-on to the end a warm-up has no time constant
/// that a fit could find.
inline constexpr double kLeastRise = 0.1;

/// Fits (X.1) by least squares to temperatures [degC] at times [s] since
/// power-on, which rise from 0. Where they change by less than kLeastRise,
/// start and end are their mean and tau is the default of SITL, 300 s. Throws
/// std::invalid_argument for fewer than 10 samples.
WarmUpFit fit_warm_up(std::span<const double> times,
                      std::span<const double> temperatures);

/// Returns (X.1) at time t [s].
double warm_up_temperature(const WarmUpFit& fit, double t);

/// Returns the cubic [deg/s] of a temperature [degC] that is nearest to `bias`
/// by least squares. `temperatures` are four or more. Throws
/// std::invalid_argument when they do not determine a cubic.
BiasModel disturbance_cubic(std::span<const double> temperatures,
                            std::span<const double> bias);

/// Returns the parameters of SITL that disturb its gyro: lines "NAME,VALUE".
/// With x = T - (TMIN + TMAX)/2 in single precision, and no limits to T,
///
///   gyro += 1e-6 (c_1 x + c_2 x^2 + c_3 x^3) + BIAS   [rad/s]         (X.2)
///
/// The polynomial has no constant: SIM_GYRn_BIAS is the bias at the middle.
/// Axes that are not given have c_k = BIAS = 0. `remarks` become comments.
/// Throws as ardupilot_parameters().
std::string sitl_parameters(const std::vector<AutopilotAxis>& axes,
                            const AutopilotGyro& gyro,
                            const std::optional<WarmUpFit>& warm_up,
                            const std::vector<std::string>& remarks);

}  // namespace beamgyro::internal
