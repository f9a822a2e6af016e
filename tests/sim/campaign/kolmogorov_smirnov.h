// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace beamgyro::internal {

/// Largest distance of the empirical distribution function of `shares` from
/// that of the uniform distribution on (0, 1), times sqrt(n) + 0.12 +
/// 0.11/sqrt(n) (Stephens 1970).
double kolmogorov_smirnov(std::vector<double> shares);

/// What it exceeds in one of a hundred samples.
inline constexpr double kOnePercent = 1.628;

}  // namespace beamgyro::internal
