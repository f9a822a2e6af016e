// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// Trainings of one network from several sets of initial weights.
struct Restarts {
  std::vector<TrainSummary> summaries;  // one per restart
  std::size_t chosen = 0;               // best_network()
  BpNetwork network;                    // of the chosen restart
};

/// Returns the index of the network to keep. Of those that are no_worse() on
/// the held-out rows than the best one there, it is the one with the least
/// squared error over training and held-out rows together. Without held-out
/// rows it is the one with the least in-sample error. The rate penalty of the
/// network is added to every error, because rows at rest are predicted best by
/// cancelling the rate.
std::size_t best_network(const std::vector<BpNetwork>& networks,
                         const ScaledRows& rows, const ScaledRows& held_out,
                         const TrainOptions& options);

/// Runs `options.restarts` trainings on `options.cores` threads; 0 means one
/// per core. Restart k draws from the streams (seed, 0, k, kInitialWeights) and
/// (seed, 0, k, kSampleOrder), so the result does not depend on the threads.
/// Throws std::runtime_error when a restart diverges.
Restarts train_from_restarts(const std::vector<int>& layer_sizes,
                             const ScaledRows& rows, const ScaledRows& held_out,
                             const TrainOptions& options, std::uint64_t seed);

}  // namespace beamgyro::internal
