// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/scenario/rate_profile.h"

namespace beamgyro {

/// What the output filter, two equal poles `corner` [rad/s], shows of |a|^2
/// [m2/s4] at the times k / output_rate: of a vibration the mean square,
/// however fast it is, for the mechanics rectify it in front of the filter.
/// Exact for every signal; at t = 0 the filter has settled on the value there,
/// on a sine it has settled for ever. `axes` [m/s2] must outlive the stream.
SampleStream filtered_square_acceleration(const std::array<Signal, 3>& axes,
                                          double corner, double output_rate);

}  // namespace beamgyro
