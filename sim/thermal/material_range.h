// SPDX-License-Identifier: MIT
#pragma once

#include "config/range.h"

namespace beamgyro::internal {

/// Temperatures that the materials of a gyro stand [degC]. Files, options and
/// runs are held against this one range.
/// - Hard PZT has its Curie point at about 300 degC and keeps its polarisation
///   up to half of that in degC, the rule of its makers.
/// - Epoxies of the bond are rated to 150 degC at most.
/// - Below -100 degC the data of epoxy and elastomer end: both are glasses that
///   crack when the parts that they join shrink.
inline constexpr Range kMaterialTemperatures{-100, 150};

/// Where the linear coefficients of the ceramic hold [degC], kColdestCeramic to
/// kHottestCeramic of the device. Beyond they keep the values of the nearest
/// end.
inline constexpr Range kLinearCeramic{-40, 80};

/// What the range of the materials stands for in messages.
inline constexpr const char* kMaterialReason =
    "the temperatures that ceramic and bond stand";

}  // namespace beamgyro::internal
