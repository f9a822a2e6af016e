// SPDX-License-Identifier: MIT
#include "tests/sim/campaign/kolmogorov_smirnov.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {

double kolmogorov_smirnov(std::vector<double> shares) {
  std::sort(shares.begin(), shares.end());
  const auto n = static_cast<double>(shares.size());
  double distance = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto k = static_cast<double>(i);
    distance = std::max({distance, shares[i] - k / n, (k + 1) / n - shares[i]});
  }
  return distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
}

}  // namespace beamgyro::internal
