// SPDX-License-Identifier: MIT
#pragma once

#include "include/beamgyro/progress.h"

namespace beamgyro::internal {

/// Tells `progress`, if it is one, the share of the work that is done. Throws
/// Cancelled when it says so.
inline void report(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

}  // namespace beamgyro::internal
