// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "random/random_stream.h"
#include "sim/numerics/state_archive.h"
#include "sim/signal/noise.h"
#include "sim/stepper/loop_tick_noise.h"
#include "sim/stepper/step_inputs.h"
#include "sim/stepper/stepper_model.h"

namespace beamgyro::internal {

/// What the noise of a gyro depends on beside its random numbers.
struct NoiseConditions {
  double beam, board;  // [K]
  bool powered;
};

/// The noise of a gyro that is stepped. Its random numbers belong to ticks at
/// the times m / rate and hold from one to the next, so they do not depend on
/// where steps end; at ticks the noise is that of a run at this output rate.
class TickNoise {
 public:
  /// `rate` [Hz] is that of the ticks. The noise of tick 0 is there at once.
  /// Throws as RateNoise and LoopTickNoise.
  TickNoise(const std::shared_ptr<const StepperModel>& model,
            const StepperStart& start, double rate,
            const NoiseConditions& conditions);

  /// Goes on to the last tick at or before `t` [s]; a tick that only rounding
  /// keeps behind t counts. Throws as last_tick() and LoopTickNoise.
  void advance_to(double t, const NoiseConditions& conditions);

  /// The power switches at `t` [s]. A tick at this very time is that of a gyro
  /// which has switched. Throws as LoopTickNoise.
  void switch_power(double t, const NoiseConditions& after);

  /// Returns the number of that tick at `rate` [Hz]. Throws std::runtime_error
  /// where the streams end before.
  static std::uint64_t last_tick(double rate, double t);

  double rate() const { return rate_; }      // [Hz]
  double output() const;                     // [rad/s]
  double sensor() const { return sensor_; }  // sigma 1
  /// Of the channels of the loops [rad/s]; [Hz] [V] with the beam at `beam`
  /// [K]. A voltage at its limit has none.
  double quadrature() const;
  Eigen::Vector2d drive(double beam, bool locked) const;

  void archive(StateArchive& archive);

 private:
  void draw(std::uint64_t ticks);

  std::shared_ptr<const StepperModel> model_;
  double rate_;  // [Hz]
  bool has_sensor_, has_channels_;
  RateNoise output_noise_;
  double white_sigma_;  // of output and quadrature [rad/s]
  RandomStream sensor_stream_, quadrature_stream_;
  RandomStream frequency_stream_, voltage_stream_;
  std::optional<LoopTickNoise> loops_;  // of the envelope
  std::uint64_t tick_ = 0;
  double output_ = 0, sensor_ = 0;
  // Normal numbers.
  double quadrature_ = 0, drive_frequency_ = 0, drive_voltage_ = 0;
};

}  // namespace beamgyro::internal
