// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "sim/dynamics/envelope.h"
#include "sim/scenario/run_recorder.h"
#include "sim/signal/linear_noise.h"

namespace beamgyro {

/// Noise of mechanics and charge amplifiers behind loops and filters
/// (loop_noise()), exact at the sample times. The coefficients follow the
/// temperatures in steps of kNoiseRefresh. Without power the state does not
/// advance.
class SensingNoise {
 public:
  /// `scenario` and `gyro` must outlive it.
  SensingNoise(const Scenario& scenario, const Gyro& gyro, const RunKey& key);

  /// Adds the noise to output and quadrature of the next samples.
  void add_next(RunSamples& samples);

 private:
  const Scenario& scenario_;
  const Gyro& gyro_;
  EnvelopeOde ode_;
  RunKey key_;
  std::optional<LinearNoise> noise_;
  double beam_ = 0, board_ = 0;  // of the coefficients [K]
};

inline constexpr double kNoiseRefresh = 2.0;  // [K]

}  // namespace beamgyro
