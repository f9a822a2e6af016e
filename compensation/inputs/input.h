// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

enum class InputKind {
  kColumn,           // a measured column as it is
  kLowpass,          // temperature_lowpass(TAU), of other columns alike
  kTemperatureRate,  // temperature_rate(TAU), smoothed dT/dt [K/s]
  kTemperaturePlay,  // temperature_play(R), a play operator of T [degC]
  kSincePowerOn,     // since_power_on(TAU) = exp(-t / TAU)
};

/// One input of a compensator: a measured quantity, never the truth.
struct Input {
  InputKind kind = InputKind::kColumn;
  std::string column;      // measured column read; "" for since_power_on
  double parameter = 0.0;  // TAU [s] or R [K], > 0; 0 for kColumn

  bool operator==(const Input&) const = default;
};

/// Reads "output", "temperature", "temperature_lowpass(100)",
/// "temperature_rate(60)", "temperature_play(2)", "since_power_on(300)",
/// "quadrature_lowpass(10)", "drive_voltage_lowpass(10)", "drive_frequency",
/// "drive_voltage", "quadrature" or "rate". Throws std::invalid_argument for
/// any other name and lists these.
Input parse_input(std::string_view name);

/// Returns the name from which parse_input() reads the same input, to the last
/// bit of the parameter.
std::string input_name(const Input& input);

/// Returns whether the input is the gyro's own answer, `output` or `rate`. A
/// network with such an input can mistake the rate for drift.
bool sees_the_rate(const Input& input);

/// Returns whether the input is a low-pass of the temperature.
bool is_temperature_lowpass(const Input& input);

/// Returns whether the input reads a measured column but the temperature, and
/// whether a low-pass of it.
bool reads_a_signal(const Input& input);
bool filters_a_signal(const Input& input);

std::vector<std::string> input_names(const std::vector<Input>& inputs);

}  // namespace beamgyro::internal
