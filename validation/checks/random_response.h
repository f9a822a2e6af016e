// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "validation/checks/check_context.h"

namespace beamgyro::internal {

constexpr double kAddedShare = 0.1;  // [-], of full scale: sines, random rates

/// What the answers show of a rate that was added to one run.
struct AddedAndSeen {
  std::vector<double> added, seen;  // [deg/s]
};

/// Returns nothing for a run that no rate can be added to.
std::optional<AddedAndSeen> seen_of_added(const CheckContext& context,
                                          std::size_t number,
                                          std::vector<double> added);

/// Returns whether the run has this sample, with power.
bool is_powered_at(const Recording& run, std::size_t k);

/// Returns the run that is sampled fastest; of several the longest. There must
/// be a run.
std::size_t fastest_run(const CheckContext& context);

/// Adds a rate that is new at every sample to the fastest run. Returns nothing
/// for a run of one sample, and for one that no rate can be added to.
std::optional<RandomResponse> random_response(const CheckContext& context);

}  // namespace beamgyro::internal
