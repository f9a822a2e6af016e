// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/device/modal_model.h"
#include "sim/dynamics/gyro.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal {

/// Time in which the drive mode decays to 1/e [s].
inline double decay_time(const ModalParameters& modal) {
  return 2 * modal.mass / modal.damping(0, 0);
}

/// Zero-rate output with beam and board at one temperature [K], in rad/s.
inline double zero_rate_output(const TrimmedGyro& gyro, double T) {
  return electronics_at(gyro, T)
      .output(beam_signal(gyro, T, {}).demodulated)
      .rate;
}

struct StepResponse {
  double overshoot, settling;  // of the step; last time outside 5 % [s]
};

constexpr double kSample = 1e-4;  // [s]

/// Judges `samples` values of a response, of 1 at its end, over time [s].
inline StepResponse judged(int samples,
                           const std::function<double(double)>& response) {
  StepResponse found{0, 0};
  for (int k = 1; k <= samples; ++k) {
    const double value = response(k * kSample);
    found.overshoot = std::max(found.overshoot, value - 1);
    if (std::abs(value - 1) > 0.05) found.settling = k * kSample;
  }
  return found;
}

/// PI controller, plant gain/(s + 1/tau), two poles w_f, unity feedback: the
/// states follow the exponential of the closed loop's matrix.
inline void expect_linear_loop(int samples, const StepResponse& found, double P,
                               double I, double gain, double tau, double wf) {
  Eigen::Matrix4d A;
  A << 0, 0, 0, -1,                      //
      gain * I, -1 / tau, 0, -gain * P,  //
      0, wf, -wf, 0,                     //
      0, 0, wf, -wf;
  const Eigen::Vector4d b(1, gain * P, 0, 0);
  const Eigen::Vector4d rest = -reference::solution(A, b);
  const Eigen::Matrix4d sample = reference::exponential(A * kSample);
  Eigen::Vector4d x = -rest;
  const StepResponse model = judged(samples, [&](double) {
    x = sample * x;
    return (rest + x)(3);
  });
  EXPECT_NEAR(found.overshoot, model.overshoot, 0.05);
  EXPECT_NEAR(found.settling / model.settling, 1, 0.05);
}

}  // namespace beamgyro::internal
