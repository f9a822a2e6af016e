// SPDX-License-Identifier: MIT
#pragma once

#include "random/random_stream.h"

namespace beamgyro::internal {

// The random stream that this room draws from. The number is part of the data:
// never change it, never use it twice (all of them are compared by a test).
inline constexpr RandomPurpose kResidualForecastStream{25};

}  // namespace beamgyro::internal
