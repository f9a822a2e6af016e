// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "validation/evidence/evidence.h"
#include "validation/metrics/bias_filter.h"

namespace beamgyro::internal {

/// Mean residuals over the sigma that is stated for them, z. Those of a group
/// share their cause and count as one.
struct ErrorGroup {
  std::size_t cluster;    // groups of one cluster may depend on each other
  std::vector<double> z;  // [-], at least one
};

/// Squared innovations of a bias filter over what it expected.
struct FilterRun {
  std::size_t cluster;
  std::vector<double> normalised;  // [-]
};

/// What the runs show about the sigma that a compensator states.
struct SigmaEvidence {
  std::vector<ErrorGroup> soaks, ramps;
  std::vector<FilterRun> filter;

  /// Adds the evidence of another device, as one cluster.
  void add_device(const SigmaEvidence& device, std::size_t cluster);
};

/// Returns whether a rate of `evidence` has a sigma.
bool states_sigma(const Evidence& evidence);

/// Returns the errors in the runs of soaks and of ramps whose rate has a sigma,
/// each group as a cluster of its own:
/// - of the soaks (soaks_of()), the means over their ends;
/// - of the blocks of 60 s, those whose temperature moves by 0.05 K/min or
/// more. What follows each other within 10 K is one group, since the bias
/// hardly changes. sigma of a mean is the root of its mean square. What is not
/// finite is left out.
std::vector<ErrorGroup> soak_errors(const Evidence& evidence);
std::vector<ErrorGroup> ramp_errors(const Evidence& evidence);

/// Returns filter_innovations() of these runs, of warm-ups and power cycles.
std::vector<FilterRun> filter_runs(const Evidence& evidence);

/// Returns all three.
SigmaEvidence sigma_evidence(const Evidence& evidence);

}  // namespace beamgyro::internal
