// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace beamgyro::internal {

/// Errors of the electronics that measure the channels of the loops.
struct LoopChannelParameters {
  bool noise = false;                // whether the channels carry noise
  double clock_offset = 0;           // y_0, relative
  double clock_tc2 = 0;              // y_T [1/K2]
  double clock_ageing = 0;           // relative, per year
  double voltage_gain_error = 0;     // at T_0, relative
  double voltage_gain_tc = 0;        // [1/K]
  double quadrature_offset = 0;      // at T_0 [rad/s]
  double quadrature_offset_tc = 0;   // [rad/s/K]
  double quadrature_offset_tc2 = 0;  // [rad/s/K2]
};

inline constexpr double kYear = 31557600;  // 365.25 days [s]

/// Returns what the channels show of their noise-free values, with the board dT
/// [K] above T_0 and an age t since the trim [s]:
///   frequency   f_d (1 + y_0 + y_T dT^2 + y_a t / year) + noise,
///   voltage     V_D (1 + g_0 + g_T dT) + noise,
///   quadrature  Q + q_0 + q_T dT + q_T2 dT^2 + noise.
/// A clock that counts slow shows a high frequency, so y is the error of the
/// counted frequency. No resolution is applied.
double measured_frequency(const LoopChannelParameters& channels,
                          double frequency, double noise, double dT,
                          double age);
double measured_voltage(const LoopChannelParameters& channels, double voltage,
                        double noise, double dT);
double measured_quadrature(const LoopChannelParameters& channels,
                           double quadrature, double noise, double dT);

/// The same of many samples. `noise` is empty or has one value for each; no
/// resolution is applied.
std::vector<double> measured_frequency(const LoopChannelParameters& channels,
                                       std::span<const double> frequency,
                                       std::span<const double> noise,
                                       std::span<const double> dT,
                                       std::span<const double> age);
std::vector<double> measured_voltage(const LoopChannelParameters& channels,
                                     std::span<const double> voltage,
                                     std::span<const double> noise,
                                     std::span<const double> dT);
std::vector<double> measured_quadrature(const LoopChannelParameters& channels,
                                        std::span<const double> quadrature,
                                        std::span<const double> noise,
                                        std::span<const double> dT);

}  // namespace beamgyro::internal
