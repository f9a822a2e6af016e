// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include "include/beamgyro/device.h"

namespace beamgyro::internal {

/// The steady state at 25 degC.
struct SteadyFigures {
  double frequency, split;  // [Hz]
  double quality;           // of the drive mode
  double drive_voltage;     // [V]
};

/// Throws as characterise().
SteadyFigures steady_figures(const Device& device);

/// Returns the difference between the largest and the least bias [deg/s] over
/// beam temperatures [degC]. Throws as characterise().
double bias_over(const Device& device, std::pair<double, double> range);

/// How the sensor warms up in still air at 25 degC.
struct WarmUpFigures {
  double rise;  // of the sensor [K], over the air
  double time;  // to 95 % of the way from power-on to the end [s]
};
WarmUpFigures warm_up_figures(const Device& device);

/// Returns the angle random walk N [deg/sqrt(s)] of an hour at rest: that of
/// the Allan deviation of a run with noise less the same run without. Nothing
/// where the curve shows none.
std::optional<double> noise_figure(const Device& device);

/// The response to a step of the rate, with every loop and filter.
struct ResponseFigures {
  // [Hz] at which it first falls by 3 dB; nothing beyond the 800 Hz that such a
  // run shows.
  std::optional<double> bandwidth;
  double peak = 1, peak_frequency = 0;  // of the gain [-] [Hz]
};
ResponseFigures response_figures(const Device& device);

}  // namespace beamgyro::internal
