// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>

#include "validation/metrics/metric_tables.h"

namespace beamgyro::internal {
namespace {

std::vector<Metric> all_tables() {
  std::vector<Metric> all;
  for (const auto table :
       {temperature_metrics, residual_metrics, hysteresis_metrics,
        start_metrics, scale_factor_metrics, noise_metrics, response_metrics,
        motion_metrics, sigma_metrics})
    std::ranges::move(table(), std::back_inserter(all));
  return all;
}

}  // namespace

double shortfall_of(const Metric& metric, double value) {
  return std::isinf(metric.best) ? -value : std::abs(value - metric.best);
}

std::span<const Metric> metrics() {
  static const std::vector<Metric> kMetrics = all_tables();
  return kMetrics;
}

const Metric* find_metric(std::string_view name) {
  const std::span<const Metric> all = metrics();
  const auto found = std::ranges::find(all, name, &Metric::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace beamgyro::internal
