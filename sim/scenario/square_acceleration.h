// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/scenario/rate_profile.h"

namespace beamgyro::internal {

/// Returns |a|^2 [m2/s4] behind the output filter, two equal poles `corner`
/// [rad/s], at the times k / output_rate. The mechanics rectify a vibration in
/// front of the filter, so a fast vibration gives its mean square. The result
/// is exact for every signal. At t = 0 the filter has settled on the value
/// there; on a sine it gives the periodic response. `axes` [m/s2] must outlive
/// the stream.
SampleStream filtered_square_acceleration(const std::array<Signal, 3>& axes,
                                          double corner, double output_rate);

}  // namespace beamgyro::internal
