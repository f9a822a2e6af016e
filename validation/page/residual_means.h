// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// Means over a block of samples of a run.
struct ResidualMean {
  double since_power_on;  // [s]
  double temperature;     // [degC], measured; NaN without
  double residual;        // [deg/s], judged less true rate
};

/// Returns the means over blocks of `least` [s], or of so many more that there
/// are about kFigurePoints at most. A block with a sample without a rate is
/// left out.
std::vector<ResidualMean> residual_means(const EvidenceRun& run, double least);

}  // namespace beamgyro::internal
