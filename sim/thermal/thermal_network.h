// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

enum ThermalNode { kBeam, kPzt, kMount, kHousing, kBoard, kSensor };
inline constexpr int kThermalNodeCount = 6;
inline constexpr std::array<std::string_view, kThermalNodeCount>
    kThermalNodeNames = {"beam", "pzt", "mount", "housing", "board", "sensor"};

using NodeVector = Eigen::Matrix<double, kThermalNodeCount, 1>;
using NodeMatrix = Eigen::Matrix<double, kThermalNodeCount, kThermalNodeCount>;

struct ThermalSurroundings {
  double ambient;        // [K], of air, walls and fixture
  bool stirred = false;  // chamber with forced convection
};

/// Heat that leaves the housing [W].
struct HeatLoss {
  double natural_convection, radiation, forced_convection, fixture;
  double total() const {
    return natural_convection + radiation + forced_convection + fixture;
  }
};

/// Lumped heat flow, equation (4.1), temperatures in [K], power in [W]:
///
///   C_i dT_i/dt = P_i + sum_j G_ij (T_j - T_i) - (loss of the housing)
///   loss = 1.42 A L^-1/4 |d|^1/4 d + eps sigma A (T^4 - Ta^4)
///          + [stirred] h A d + G_fixture d,        d = T_housing - Ta
class ThermalNetwork {
 public:
  /// Throws as require_valid().
  explicit ThermalNetwork(const ThermalParameters& parameters);

  const ThermalParameters& parameters() const { return parameters_; }
  const NodeVector& heat_capacity() const { return heat_capacity_; }  // [J/K]

  /// Sources while powered [W]: the electronics in the board, `mechanical` in
  /// the beam, `dielectric` in the patches.
  NodeVector powered_heating(double mechanical, double dielectric) const;

  HeatLoss heat_loss(double housing_temperature,
                     const ThermalSurroundings& surroundings) const;

  /// dT/dt [K/s].
  NodeVector heating_rate(const NodeVector& temperature,
                          const NodeVector& power,
                          const ThermalSurroundings& surroundings) const;

  /// J(i, j) = d(dT_i/dt)/dT_j [1/s]; it does not depend on the power.
  NodeMatrix heating_rate_jacobian(
      const NodeVector& temperature,
      const ThermalSurroundings& surroundings) const;

  /// Temperatures [K] at which heating_rate() vanishes, by Newton's method.
  /// An oven takes no part: its power is an entry of `power`. Throws
  /// SimulationFailure without convergence.
  NodeVector steady_state(const NodeVector& power,
                          const ThermalSurroundings& surroundings) const;

 private:
  ThermalParameters parameters_;
  NodeVector heat_capacity_;      // [J/K]
  NodeMatrix conductance_;        // [W/K], rows and columns sum to zero
  double natural_coefficient_;    // [W/K^(5/4)]
  double radiation_coefficient_;  // [W/K^4]
  double forced_conductance_;     // [W/K]
};

}  // namespace beamgyro::internal
