// SPDX-License-Identifier: MIT
#include "sim/scenario/material_limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/run_recorder.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {
namespace {

bool is_outside(double T) {
  constexpr double kRoundoff = 1e-3;  // of the integration [K]
  return T - kZeroCelsius < kMaterialTemperatures.low - kRoundoff ||
         T - kZeroCelsius > kMaterialTemperatures.high + kRoundoff;
}

}  // namespace

void MaterialLimits::check(double t, const NodeVector& nodes) const {
  for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
    const double T = nodes(static_cast<Eigen::Index>(node));
    if (!is_outside(T)) continue;
    throw SimulationFailure(fmt::format(
        "{} at {:.4g} degC at {:.6g} s, beyond {:g} to {:g} degC, {}; ambient "
        "is {:.4g} degC and thermal.electronics_power_W = {:g}",
        kThermalNodeNames[node], T - kZeroCelsius, t, kMaterialTemperatures.low,
        kMaterialTemperatures.high, kMaterialReason,
        scenario_.ambient.value(t) - kZeroCelsius, electronics_power_));
  }
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
    return std::any_of(T.begin(), T.end(), is_outside);
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
  return !is_outside(range.low) && !is_outside(range.high);
}

}  // namespace beamgyro::internal
