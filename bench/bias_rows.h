// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// A bias curve with four extrema over [-1, 1] and label noise, in `inputs`
/// variables of which the others shift the first.
ScaledRows bias_rows(Eigen::Index count, Eigen::Index inputs, double noise,
                     std::uint32_t run);

}  // namespace beamgyro::internal
