// SPDX-License-Identifier: MIT
#include "include/beamgyro/progress.h"

#include "api/reported_progress.h"

namespace beamgyro {

Cancelled::Cancelled() : std::runtime_error("cancelled") {}

namespace internal {

void report(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

}  // namespace internal
}  // namespace beamgyro
