// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_oven.h"

namespace beamgyro::internal {

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
