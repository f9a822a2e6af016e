// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/network_training.h"

namespace beamgyro {

/// Trainings of one network from several sets of initial weights.
struct Restarts {
  std::vector<TrainSummary> summaries;  // one per restart
  std::size_t chosen =
      0;              // lowest held-out rms; in-sample without held-out rows
  BpNetwork network;  // of the chosen restart
};

/// Runs `options.restarts` trainings on `options.cores` threads or, with 0, as
/// many as there are cores.
/// Restart k draws from the streams (seed, 0, k, kInitialWeights) and (seed, 0,
/// k, kSampleOrder), so the result does not depend on the threads. Throws
/// std::runtime_error when a restart diverges.
Restarts train_from_restarts(const std::vector<int>& layer_sizes,
                             const ScaledRows& rows, const ScaledRows& held_out,
                             const TrainOptions& options, std::uint64_t seed);

}  // namespace beamgyro
