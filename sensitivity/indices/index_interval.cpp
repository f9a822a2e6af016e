// SPDX-License-Identifier: MIT
#include "sensitivity/indices/index_interval.h"

#include <algorithm>
#include <cmath>

#include "statistics/intervals.h"

namespace beamgyro::internal {

IndexEstimate with_interval(double value, std::vector<double> replicates) {
  std::erase_if(replicates, [](double each) { return !std::isfinite(each); });
  if (replicates.empty()) return {value, value, value};
  std::sort(replicates.begin(), replicates.end());
  return {value, percentile(replicates, kIntervalTail),
          percentile(replicates, 1 - kIntervalTail)};
}

}  // namespace beamgyro::internal
