// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

using SignalOfTime = std::function<double(double)>;

/// A gyro of 12.5 mV/(deg/s) about 2.5 V whose signals are known in closed
/// form: rate = scale_factor * true_rate + bias.
struct RecordedRun {
  double duration = 600.0;                                 // [s]
  double step = 0.5;                                       // [s]
  SignalOfTime true_rate = [](double) { return 0.0; };     // [deg/s]
  SignalOfTime bias = [](double) { return 0.0; };          // [deg/s]
  SignalOfTime temperature = [](double) { return 25.0; };  // [degC]
  SignalOfTime scale_factor = [](double) { return 1.0; };  // [-]
  std::function<bool(double)> powered = [](double) { return true; };

  Recording recording() const;
};

/// Rates -full_scale ... full_scale in `rates` even steps, each held for `hold`
/// [s], over and over.
SignalOfTime rate_table(double full_scale, int rates, double hold);

}  // namespace beamgyro::internal
