// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>

#include "compensation/scoring/rate_injection.h"

namespace beamgyro::internal {

/// Returns the least scale factor retained in a block of a replay, or nothing
/// where replay() returns nothing or no block.
inline std::optional<double> injected_scale_factor(
    const RateEstimator& estimator, const Recording& recording) {
  const auto blocks =
      replay(estimator, recording, estimator(recording), kFullScale);
  if (!blocks || blocks->empty()) return std::nullopt;
  return std::ranges::min_element(*blocks, {}, &ReplayedBlock::retained)
      ->retained;
}

}  // namespace beamgyro::internal
