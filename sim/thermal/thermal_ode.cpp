// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_ode.h"

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

ThermalOde::ThermalOde(const ThermalNetwork& network, double mechanical,
                       double dielectric)
    : network_(network),
      powered_heating_(network.powered_heating(mechanical, dielectric)) {}

OvenAction ThermalOde::oven(bool powered,
                            const Eigen::Ref<const Eigen::VectorXd>& y) const {
  if (!powered) return {};
  return oven_action(*network_.parameters().oven, y(kMount),
                     y(kThermalNodeCount));
}

void ThermalOde::rate(const ThermalSurroundings& surroundings, bool powered,
                      const Eigen::Ref<const Eigen::VectorXd>& y,
                      Eigen::Ref<Eigen::VectorXd> dydt) const {
  const NodeVector temperature = y.head<kThermalNodeCount>();
  NodeVector power = NodeVector::Zero();
  if (powered) power = powered_heating_;
  if (has_oven()) {
    const OvenAction action = oven(powered, y);
    power(kMount) += action.power;
    dydt(kThermalNodeCount) = action.integral_rate;
  }
  dydt.head<kThermalNodeCount>() =
      network_.heating_rate(temperature, power, surroundings);
}

void ThermalOde::jacobian(const ThermalSurroundings& surroundings, bool powered,
                          const Eigen::Ref<const Eigen::VectorXd>& y,
                          Eigen::Ref<Eigen::MatrixXd> slope) const {
  slope.setZero();
  slope.topLeftCorner<kThermalNodeCount, kThermalNodeCount>() =
      network_.heating_rate_jacobian(y.head<kThermalNodeCount>(), surroundings);
  if (!has_oven()) return;
  const OvenAction action = oven(powered, y);
  const double C = network_.heat_capacity()(kMount);
  slope(kMount, kMount) += action.power_per_mount / C;
  slope(kMount, kThermalNodeCount) = action.power_per_integral / C;
  slope(kThermalNodeCount, kMount) = action.integral_rate_per_mount;
  slope(kThermalNodeCount, kThermalNodeCount) =
      action.integral_rate_per_integral;
}

}  // namespace beamgyro::internal
