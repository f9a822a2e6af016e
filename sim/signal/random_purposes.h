// SPDX-License-Identifier: MIT
#pragma once

#include "random/random_stream.h"

namespace beamgyro::internal {

// The random streams that this room draws from. The numbers are part of the
// data: never change one, never use one twice (all of them are compared by a
// test).
inline constexpr RandomPurpose kWhiteNoiseStream{0};
inline constexpr RandomPurpose kFlickerStream{1};
inline constexpr RandomPurpose kRateRandomWalkStream{2};
inline constexpr RandomPurpose kTurnOnStream{3};
inline constexpr RandomPurpose kTemperatureSensorStream{4};
inline constexpr RandomPurpose kWalkSinceTrimStream{17};
inline constexpr RandomPurpose kTurnOnTransientStream{18};
inline constexpr RandomPurpose kQuadratureNoiseStream{19};

}  // namespace beamgyro::internal
