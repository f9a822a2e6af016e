// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {

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
