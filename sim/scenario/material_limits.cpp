// SPDX-License-Identifier: MIT
#include "sim/scenario/material_limits.h"

#include <algorithm>

#include "sim/scenario/run_recorder.h"

namespace beamgyro::internal {
void MaterialLimits::check(double t, const NodeVector& nodes) const {
  check_materials(t, nodes, scenario_.ambient.value(t), electronics_power_);
}

void MaterialLimits::check(const ThermalTrajectory& temperatures,
                           const SampleGrid& grid) const {
  std::array<std::vector<double>, kThermalNodeCount> values;
  for (std::size_t k = 0; k < grid.count; k += kBlockSamples) {
    const std::vector<double> times =
        grid.times(k, std::min(kBlockSamples, grid.count - k));
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i].resize(times.size());
      temperatures.sample(static_cast<ThermalNode>(i), k, times, values[i]);
    }
    check(times, values);
  }
}

void MaterialLimits::check(
    std::span<const double> times,
    const std::array<std::vector<double>, kThermalNodeCount>& nodes) const {
  const auto has_outside = [](const std::vector<double>& T) {
    return !std::all_of(T.begin(), T.end(), materials_stand);
  };
  if (std::none_of(nodes.begin(), nodes.end(), has_outside)) return;
  for (std::size_t k = 0; k < times.size(); ++k) {
    NodeVector now;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      now(static_cast<Eigen::Index>(i)) = nodes[i][k];
    check(times[k], now);
  }
}

bool MaterialLimits::stand(const TemperatureSpan& range) {
  return materials_stand(range.low) && materials_stand(range.high);
}

}  // namespace beamgyro::internal
