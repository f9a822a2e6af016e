// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace beamgyro::internal {

// Constants that convert the units of files and of the command line to SI.
inline constexpr double kDegree = std::numbers::pi / 180;  // [rad]
inline constexpr double kZeroCelsius = 273.15;             // [K]
inline constexpr double kStandardGravity = 9.80665;        // [m/s2]

}  // namespace beamgyro::internal
