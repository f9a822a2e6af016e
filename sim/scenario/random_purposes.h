// SPDX-License-Identifier: MIT
#pragma once

#include "random/random_stream.h"

namespace beamgyro::internal {

// The random streams that this room draws from. The numbers are part of the
// data: never change one, never use one twice (all of them are compared by a
// test).
inline constexpr RandomPurpose kRateProfileStream{5};
inline constexpr RandomPurpose kMechanicalNoiseStream{9};
inline constexpr RandomPurpose kCrossRateXStream{10};
inline constexpr RandomPurpose kCrossRateYStream{11};
inline constexpr RandomPurpose kAccelerationXStream{12};
inline constexpr RandomPurpose kAccelerationYStream{13};
inline constexpr RandomPurpose kAccelerationZStream{14};
inline constexpr RandomPurpose kDriveFrequencyNoiseStream{20};
inline constexpr RandomPurpose kDriveVoltageNoiseStream{21};

}  // namespace beamgyro::internal
