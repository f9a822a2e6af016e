// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A recording with every variable a simulated one has, off for its first fifth
/// and with every status bit somewhere. Value of column i at sample k:
/// (i + 1) k / 8 - 3, exact in binary; time k / 10 s.
Recording sample_recording(std::size_t samples);

}  // namespace beamgyro::internal
