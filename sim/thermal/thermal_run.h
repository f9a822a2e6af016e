// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "sim/numerics/cvode.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"

namespace beamgyro {

/// Powered from `on` to `off`.
struct PowerInterval {
  double on;                                             // [s]
  double off = std::numeric_limits<double>::infinity();  // [s]
};

struct ThermalLoad {
  PiecewiseLinear ambient;                  // [K] over [s]
  bool stirred = false;                     // chamber with forced convection
  std::vector<PowerInterval> powered = {};  // in order of time, not overlapping
  double mechanical_power = 0;              // [W], into the beam while powered
  double dielectric_power = 0;  // [W], into the patches while powered
};

struct ThermalRunOptions {
  /// Local error of one step [K]. 1e-7 keeps every node within 1e-5 K.
  double tolerance = 1e-7;
};

struct ThermalHistory {
  /// Node temperatures [K] by ThermalNode, one value for each time.
  std::array<std::vector<double>, kThermalNodeCount> temperature;
  std::vector<double> heater_power;  // [W]; empty without an oven
  CvodeStatistics statistics;
};

/// Temperatures of `network` at the increasing `times` >= 0 [s], by CVODE BDF
/// with a restart at every discontinuity of the load. At 0 every node is at
/// ambient with the power off before. An oven works while powered and starts
/// at every power-on with an empty integral. Throws std::invalid_argument for
/// times or power intervals out of order or a power below zero,
/// std::runtime_error as Cvode.
ThermalHistory simulate_temperatures(const ThermalNetwork& network,
                                     const ThermalLoad& load,
                                     std::span<const double> times,
                                     const ThermalRunOptions& options = {});

}  // namespace beamgyro
