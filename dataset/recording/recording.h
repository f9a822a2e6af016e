// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "include/beamgyro/recording.h"

namespace beamgyro::internal {

/// Returns the position of `status` among the columns of a file: before the
/// column of this index, the first one that is not measured.
std::size_t status_position(const Recording& recording);

}  // namespace beamgyro::internal
