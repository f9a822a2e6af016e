// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// The temperatures of a powered device in a stirred chamber, at the end of
/// long soaks. The sensor is warmer than the chamber, because the electronics
/// heat it.
class ChamberView {
 public:
  /// `offset` [K] is what the sensor adds to its temperature. Throws
  /// std::invalid_argument for a device with an oven, otherwise as
  /// ThermalNetwork.
  explicit ChamberView(const ThermalParameters& parameters,
                       double offset = 0.0);

  /// Returns the temperature [degC] that the sensor settles to show. Throws
  /// SimulationFailure as ThermalNetwork::steady_state().
  double sensor_temperature(double chamber) const;  // [degC]
  Eigen::ArrayXd sensor_temperatures(const Eigen::ArrayXd& chamber) const;

  /// Returns the temperature of the chamber [degC] at which the sensor settles
  /// to show `sensor` [degC].
  double chamber_temperature(double sensor) const;

  /// Returns the temperature of the beam less that of the sensor [K], settled,
  /// without its offset.
  double beam_excess(double chamber) const;  // [degC]

 private:
  NodeVector settled(double chamber) const;

  ThermalNetwork network_;
  double offset_;  // [K]
};

}  // namespace beamgyro::internal
