// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "sim/numerics/ode.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// Powered from `on` to `off`.
struct PowerInterval {
  double on;                                             // [s]
  double off = std::numeric_limits<double>::infinity();  // [s]
};

/// Whether one of the intervals holds `t` [s].
bool powered_at(std::span<const PowerInterval> powered, double t);

struct ThermalLoad {
  PiecewiseLinear ambient;                  // [K] over [s]
  bool stirred = false;                     // chamber with forced convection
  std::vector<PowerInterval> powered = {};  // in order of time, not overlapping
  double mechanical_power = 0;              // [W], into the beam while powered
  double dielectric_power = 0;  // [W], into the patches while powered
};

struct ThermalHistory {
  /// Node temperatures [K] by ThermalNode, one value for each time.
  std::array<std::vector<double>, kThermalNodeCount> temperature;
  std::vector<double> heater_power;  // [W]; empty without an oven
};

/// What an integration of temperatures hands over in order of time: the state
/// of ThermalOde.
struct ThermalSink {
  /// The state at `t` [s], and at earlier times not handed over yet.
  std::function<void(double t, const Eigen::VectorXd& y)> on_state;
  /// A step; its end comes with the next step or state.
  std::function<void(const OdeStep& step)> on_step;
};

/// Integrates the temperatures of `network` over [0, end] [s], by CVODE BDF
/// with a restart at every discontinuity of the load. At 0 every node is at
/// ambient with the power off before. An oven works while powered and starts at
/// every power-on with an empty integral. `tolerance` is the local error of a
/// step [K]; the default keeps every node within 1e-5 K. Throws
/// std::invalid_argument for power intervals out of order or a power below
/// zero, SimulationFailure as Cvode.
void integrate_temperatures(const ThermalNetwork& network,
                            const ThermalLoad& load, double end,
                            const ThermalSink& sink, double tolerance = 1e-7);

/// The temperatures at increasing `times` >= 0 [s]. Throws
/// std::invalid_argument for times out of order, otherwise as
/// integrate_temperatures().
ThermalHistory simulate_temperatures(const ThermalNetwork& network,
                                     const ThermalLoad& load,
                                     std::span<const double> times,
                                     double tolerance = 1e-7);

}  // namespace beamgyro::internal
