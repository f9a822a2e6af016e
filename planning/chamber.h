// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// What a soak costs in a chamber.
struct ChamberTime {
  double start = 25.0;   // [degC], at which chamber and device begin
  double ramp = 2.0;     // [K/min], > 0
  double hold = 2700.0;  // [s], > 0, of each soak
};

/// Returns the temperatures in the order of the shortest way through all of
/// them: from the start to the nearer end, then to the other one.
std::vector<double> in_visiting_order(std::vector<double> temperatures,
                                      double start);

/// Returns the length of that way [K]; 0 without temperatures.
double shortest_way(const std::vector<double>& temperatures, double start);

/// Returns the time [h] from the start to the end of the last soak: ramps over
/// the shortest way, and the holds.
double chamber_hours(const std::vector<double>& temperatures,
                     const ChamberTime& time);

/// A soak of a schedule.
struct Visit {
  double temperature;  // [degC]
  double begin, end;   // [s], of the hold
};

/// Returns the soaks in visiting order with the times of their holds.
std::vector<Visit> visits(const std::vector<double>& temperatures,
                          const ChamberTime& time);

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
