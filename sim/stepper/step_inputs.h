// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/device/case_axis.h"
#include "sim/numerics/piecewise_linear.h"
#include "sim/thermal/thermal_network.h"

namespace beamgyro::internal {

/// What acts on a gyro at one moment.
struct StepInputs {
  PerAxis<double> motion{};  // of the case [rad/s] [m/s2]
  double ambient = 298.15;   // [K]

  friend bool operator==(const StepInputs&, const StepInputs&) = default;
};

enum class StepFidelity {
  kQuasistatic,  // beam and loops are settled at every moment
  kEnvelope,     // amplitudes and loops over time
};

/// The fidelity of that name. Throws std::invalid_argument for another one.
StepFidelity step_fidelity(std::string_view name);

/// How a gyro that is stepped begins, and what stays the same.
struct StepperStart {
  StepFidelity fidelity = StepFidelity::kQuasistatic;
  std::uint64_t seed = 0;
  std::uint32_t device = 0, run = 0;  // of the random streams
  bool noise = true;
  /// Rate of the noise [Hz]: its number m holds from m / noise_rate until the
  /// next. 0: one over the duration of the first step.
  double noise_rate = 0;
  bool stirred = false;  // chamber with forced convection
  StepInputs inputs = {};
  bool powered = true;
  /// Of every node [K]; none: all at the ambient.
  std::optional<NodeVector> temperatures = {};
  /// Since the factory trim [s], where it is known.
  std::optional<double> age = {};
  std::optional<PiecewiseLinear> history = {};  // [K]; ends at the start
};

/// What a gyro shows at one moment, and the truth, in the units of a recording
/// (docs/reference/recording.md). Without power what is measured is NaN. What a
/// unit does not have is NaN.
struct StepSample {
  double time;  // [s]
  double output, rate, temperature, drive_frequency, drive_voltage, quadrature;
  bool powered, saturated, locked;
  double true_rate, true_bias, true_spurious_bias, true_drive_frequency;
  double true_cross_rate_x, true_cross_rate_y;
  double true_acceleration_x, true_acceleration_y, true_acceleration_z;
  double true_fictive_temperature, true_hysteresis;
  std::array<double, kThermalNodeCount> true_node_temperature;
  double true_ambient_temperature;
};

}  // namespace beamgyro::internal
