// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace beamgyro::internal::thermal_trajectory_test {
namespace {

const ThermalNetwork& network() {
  static const ThermalNetwork network{ThermalParameters{}};
  return network;
}

ThermalLoad ramps_and_power_cycles() {
  return {.ambient =
              PiecewiseLinear({0, 50, 70, 70, 400}, {283, 283, 298, 290, 313}),
          .powered = {{0, 60}, {100.25}},
          .mechanical_power = 1e-4};
}

// Samples far apart are kept as values, close ones as polynomials.
TEST(ThermalTrajectory, HoldsTheTemperaturesOfTheSamplesToTheLastBit) {
  for (const double rate : {0.01, 0.05, 0.5, 7.3, 200.0}) {
    const SampleGrid grid{rate, static_cast<std::size_t>(600 * rate)};
    const ThermalHistory history = simulate_temperatures(
        network(), ramps_and_power_cycles(), grid.times(0, grid.count));
    const ThermalTrajectory trajectory(network(), ramps_and_power_cycles(),
                                       grid);
    for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
      const std::vector<double>& expected = history.temperature[node];
      std::vector<double> temperature(grid.count);
      // Blocks of one to a dozen samples begin anywhere in a step.
      for (std::size_t k = 0, n = 1; k < grid.count; k += n, n = n % 12 + 1) {
        const std::size_t count = std::min(n, grid.count - k);
        trajectory.sample(static_cast<ThermalNode>(node), k,
                          grid.times(k, count),
                          std::span(temperature).subspan(k, count));
      }
      EXPECT_EQ(temperature, expected) << rate << " Hz, node " << node;
      const auto [low, high] =
          std::minmax_element(expected.begin(), expected.end());
      const TemperatureSpan range =
          trajectory.range(static_cast<ThermalNode>(node));
      EXPECT_EQ(range.low, *low);
      EXPECT_EQ(range.high, *high);
    }
  }
}

}  // namespace
}  // namespace beamgyro::internal::thermal_trajectory_test
