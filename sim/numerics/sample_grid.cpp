// SPDX-License-Identifier: MIT
#include "sim/numerics/sample_grid.h"

namespace beamgyro::internal {

std::vector<double> SampleGrid::times(std::size_t first, std::size_t n) const {
  std::vector<double> times(n);
  for (std::size_t i = 0; i < n; ++i) times[i] = time(first + i);
  return times;
}

std::size_t SampleGrid::first_from(double t) const {
  if (!(t > 0)) return 0;
  std::size_t k = t * rate < static_cast<double>(count)
                      ? static_cast<std::size_t>(t * rate)
                      : count;
  // The product may be a rounding beside the sample.
  while (k < count && time(k) < t) ++k;
  while (k > 0 && time(k - 1) >= t) --k;
  return k;
}

}  // namespace beamgyro::internal
