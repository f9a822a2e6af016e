// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/compensator.h"
#include "compensation/model_file.h"
#include "compensation/network_training.h"
#include "compensation/training_rows.h"

namespace beamgyro {

struct TrainResult {
  Compensator compensator;
  std::vector<TrainSummary> restarts;  // one unless it is a network; [deg/s]
  std::size_t chosen = 0;              // the restart kept
  Eigen::Index rows = 0;
  Eigen::Index held_out_rows = 0;

  const TrainSummary& summary() const { return restarts[chosen]; }
};

/// Fits `spec` and the baseline, the cubic of equation (1), to the rows of
/// `runs` (training_rows()); a network also stops early on the rows of
/// `held_out`, and of its restarts the one with the lowest held-out rms is
/// kept. Restart k starts from the stream (seed, 0, k, kInitialWeights).
///
/// Throws std::invalid_argument when there is no run, a network has no held-out
/// run, a run is on both sides, the temperatures are too few or too close
/// together for a polynomial, an input never varies, or as training_rows().
TrainResult train(const ModelSpec& spec, const std::vector<TrainingRun>& runs,
                  const std::vector<TrainingRun>& held_out, std::uint64_t seed);

}  // namespace beamgyro
