// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// What an oven does at one moment, with its slopes for a Jacobian.
struct OvenAction {
  double power;                       // [W], into the mount
  double power_per_mount;             // [W/K]
  double power_per_integral;          // 1
  double integral_rate;               // [W/s]
  double integral_rate_per_mount;     // [W/(s K)]
  double integral_rate_per_integral;  // [1/s]
};

/// PI control of the mount's temperature by a heater of limited power,
/// equation (4.3), e = set point - T_mount, u = kP e + I:
///
///   P = min(max(u, 0), P_max),   dI/dt = (kP / t_I) e w
///
/// w = 1, but falls linearly from 1 to 0 while u runs past a limit by up to a
/// tenth of P_max and e would drive it further: the integral rests while the
/// heater saturates, and the right-hand side stays Lipschitz continuous.
OvenAction oven_action(const ThermalOven& oven, double mount_temperature,
                       double integral);

struct OvenSteadyState {
  NodeVector temperature;  // [K]
  double heater_power;     // [W]
};

/// The state in which the mount is at the set point, or the heater at the
/// limit that comes closest. `power` [W] holds the other sources. Throws as
/// ThermalNetwork::steady_state().
OvenSteadyState oven_steady_state(const ThermalNetwork& network,
                                  const ThermalOven& oven,
                                  const NodeVector& power,
                                  const ThermalSurroundings& surroundings);

/// The network with its sources as a differential equation: the state is the
/// temperature of every node [K], followed by the oven's integral [W] if there
/// is an oven. Sources and oven work while powered.
class ThermalOde {
 public:
  /// `mechanical` and `dielectric` heating while powered [W].
  ThermalOde(const ThermalNetwork& network, double mechanical,
             double dielectric);

  bool has_oven() const { return network_.parameters().oven.has_value(); }
  Eigen::Index size() const { return kThermalNodeCount + (has_oven() ? 1 : 0); }

  /// dy/dt; fills every entry.
  void rate(const ThermalSurroundings& surroundings, bool powered,
            const Eigen::Ref<const Eigen::VectorXd>& y,
            Eigen::Ref<Eigen::VectorXd> dydt) const;

  /// d(dy/dt)_i / dy_j; fills every entry.
  void jacobian(const ThermalSurroundings& surroundings, bool powered,
                const Eigen::Ref<const Eigen::VectorXd>& y,
                Eigen::Ref<Eigen::MatrixXd> slope) const;

 private:
  OvenAction oven(bool powered,
                  const Eigen::Ref<const Eigen::VectorXd>& y) const;

  ThermalNetwork network_;
  NodeVector powered_heating_;  // [W]
};

}  // namespace beamgyro::internal
