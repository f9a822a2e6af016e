// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Where a spurious mode meets the drive frequency, and the bump of the
/// zero-rate output there, to first order (13.4).
struct SpuriousBump {
  std::string mode;    // its name
  double temperature;  // T_c [K]
  double height;       // e_x e_y w_0/(2 eta_s gamma), signed [rad/s]
  double width;        // at half height, eta_s/|a_s - a_d| [K]
};

/// Returns the bumps between two temperatures [K] of beam and housing, the
/// modes in their order. `drive_frequency` is w_d [rad/s] of the unit without
/// spurious modes at a beam temperature [K].
std::vector<SpuriousBump> spurious_bumps(
    const TrimmedGyro& gyro, double low, double high,
    const std::function<double(double T)>& drive_frequency);

/// The same from the exact solution.
std::vector<SpuriousBump> spurious_bumps(const TrimmedGyro& gyro, double low,
                                         double high);

}  // namespace beamgyro::internal
