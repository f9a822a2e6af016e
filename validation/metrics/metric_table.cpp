// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "compensation/scoring/residual_scores.h"
#include "validation/metrics/metric.h"

namespace beamgyro {

std::span<const Metric> metrics() {
  static const std::vector<Metric> kMetrics = {};
  return kMetrics;
}

const Metric* find_metric(std::string_view name) {
  const std::span<const Metric> all = metrics();
  const auto found = std::ranges::find(all, name, &Metric::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace beamgyro
