// SPDX-License-Identifier: MIT
#pragma once

#include "random/random_stream.h"

namespace beamgyro::internal {

// The random stream that the intervals of metrics draw from: see
// sim/signal/random_purposes.h.
inline constexpr RandomPurpose kIntervalStream{16};

}  // namespace beamgyro::internal
