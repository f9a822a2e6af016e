// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro::internal {

/// The deviations of NIST SP 1065. Of rates y_k with the angles x_k (sums of
/// rates times the interval tau_0), tau = m tau_0, and Delta the difference of
/// values m apart, their variances are:
///
///   adev, oadev   <(Delta^2 x)^2> / (2 tau^2), every m-th start or all (o)
///   mdev          the same of means of m neighbouring Delta^2 x
///   hdev, ohdev   <(Delta^3 x)^2> / (6 tau^2), every m-th start or all (o)
///   totdev        as oadev, of angles continued by reflection at both ends:
///                 2 x_0 - x_j before the first, 2 x_n - x_{n-j} after the last
enum class DeviationKind { kAdev, kOadev, kMdev, kHdev, kOhdev, kTotdev };

/// The kind of that name. Throws std::invalid_argument for any other word.
DeviationKind deviation_kind(std::string_view name);

std::string name_of(DeviationKind kind);

/// Returns 3 for the Hadamard deviations, which a ramp does not reach, else 2.
int order_of(DeviationKind kind);

}  // namespace beamgyro::internal
