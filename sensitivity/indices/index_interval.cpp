// SPDX-License-Identifier: MIT
#include "sensitivity/indices/index_interval.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace beamgyro::internal {

double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] +
         (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

IndexEstimate with_interval(double value, std::vector<double> replicates) {
  std::erase_if(replicates, [](double each) { return !std::isfinite(each); });
  if (replicates.empty()) return {value, value, value};
  std::sort(replicates.begin(), replicates.end());
  return {value, percentile(replicates, 0.025), percentile(replicates, 0.975)};
}

}  // namespace beamgyro::internal
