// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// What a rate leaves of the drift: means of rate - true_rate over the blocks
/// of score_blocks(), of the runs that are quiet, or of all where none is.
struct LeftDrift {
  std::vector<double> means;          // [deg/s]
  std::vector<std::size_t> clusters;  // one for each mean, rising
};
LeftDrift left_drift(const Evidence& evidence);

/// What is left when a constant is fitted to these runs themselves.
LeftDrift without_mean(LeftDrift drift);

/// Two rates on the same runs. Noise and turn-on offset are in both, so the
/// difference is known better than either.
struct PairedResidual {
  double rms = 0.0, other_rms = 0.0;  // [deg/s]
  // Logarithm of the mean square of the other over that of the rate, and the
  // half-width of its 95 % interval (Student's t over clusters, eighths of
  // runs) [-]; infinite where there is one cluster only.
  double gain = 0.0, half_width = 0.0;

  /// Not by rounding, where both rates are the same.
  bool is_better() const { return gain > half_width + 1e-9; }
};

/// Returns nothing where nothing can be compared: without a block, or with a
/// mean that is not finite.
std::optional<PairedResidual> paired_residual(const LeftDrift& drift,
                                              const LeftDrift& other);

}  // namespace beamgyro::internal
