// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_oven.h"

#include <algorithm>
#include <cmath>

#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {

OvenAction oven_action(const ThermalOven& oven, double mount_temperature,
                       double integral) {
  const double error = oven.set_point - mount_temperature;
  const double demand = oven.proportional_gain * error + integral;
  const double integral_gain = oven.proportional_gain / oven.integral_time;

  const double sign = error > 0 ? 1 : -1;
  const double past_limit =
      error > 0 ? demand - oven.max_power : -demand;  // [W]
  const double band = 0.1 * oven.max_power;           // [W]
  const double weight = std::clamp(1 - past_limit / band, 0.0, 1.0);
  const bool falling = weight > 0 && weight < 1;
  const double weight_per_demand = falling ? -sign / band : 0;
  const bool free = demand > 0 && demand < oven.max_power;

  return {
      .power = std::clamp(demand, 0.0, oven.max_power),
      .power_per_mount = free ? -oven.proportional_gain : 0,
      .power_per_integral = free ? 1.0 : 0.0,
      .integral_rate = integral_gain * error * weight,
      .integral_rate_per_mount =
          -integral_gain *
          (weight + error * weight_per_demand * oven.proportional_gain),
      .integral_rate_per_integral = integral_gain * error * weight_per_demand};
}

OvenSteadyState oven_steady_state(const ThermalNetwork& network,
                                  const ThermalOven& oven,
                                  const NodeVector& power,
                                  const ThermalSurroundings& surroundings) {
  const auto heated = [&](double heater) {
    NodeVector total = power;
    total(kMount) += heater;
    return OvenSteadyState{network.steady_state(total, surroundings), heater};
  };
  OvenSteadyState low = heated(0), high = heated(oven.max_power);
  if (low.temperature(kMount) >= oven.set_point) return low;
  if (high.temperature(kMount) <= oven.set_point) return high;

  // The mount's temperature is a nearly linear, increasing function of the
  // heater power: the secant through the bracket converges at once.
  constexpr int kMaxIterations = 50;
  constexpr double kSmallestError = 1e-9;  // [K]
  for (int i = 0; i < kMaxIterations; ++i) {
    const double below = low.temperature(kMount) - oven.set_point;
    const double above = high.temperature(kMount) - oven.set_point;
    OvenSteadyState next = heated(
        low.heater_power -
        below * (high.heater_power - low.heater_power) / (above - below));
    const double error = next.temperature(kMount) - oven.set_point;
    if (std::abs(error) < kSmallestError) return next;
    (error < 0 ? low : high) = next;
  }
  throw SimulationFailure("oven steady state: no convergence");
}

}  // namespace beamgyro::internal
