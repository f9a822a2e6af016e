// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/device_design.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument for a figure of a data sheet that is out of its
/// range, and for two that contradict each other.
void require_sound(const DataSheet& sheet);

/// Length over side of a beam, at least and at most. Assumed: a block is no
/// beam, and no patch fits on a hair.
inline constexpr double kStoutest = 5, kSlenderest = 200;
bool is_beam(double length, double side);  // [m]

/// Returns "name = value" of each figure that is given.
std::vector<std::string> figures_of(const DataSheet& sheet);

/// What follows from the figures, without a device. Nothing where the sheet
/// does not tell.
std::optional<double> walk_of(const DataSheet& sheet);        // [deg/sqrt(s)]
std::optional<double> resolution_of(const DataSheet& sheet);  // [K]
std::optional<double> power_of(const DataSheet& sheet);       // [W]
std::optional<double> full_scale_of(const DataSheet& sheet);  // [deg/s]

/// -3 dB of two equal poles over the corner of each: sqrt(sqrt(2) - 1).
extern const double kPairOverCorner;

/// Temperatures of the sensor [degC] that its bits divide, without a range.
inline constexpr std::pair<double, double> kSensorRange{-40, 88};

}  // namespace beamgyro::internal
