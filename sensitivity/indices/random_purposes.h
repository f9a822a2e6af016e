// SPDX-License-Identifier: MIT
#pragma once

#include "random/random_stream.h"

namespace beamgyro::internal {

// The random streams that this room draws from. The numbers are part of the
// data: never change one, never use one twice (all of them are compared by a
// test). Nothing draws from 23.
inline constexpr RandomPurpose kIndexResampleStream{22};
inline constexpr RandomPurpose kRankSampleStream{24};

}  // namespace beamgyro::internal
