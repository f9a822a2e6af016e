// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

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

}  // namespace beamgyro::internal
