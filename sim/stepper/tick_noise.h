// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "random/random_stream.h"
#include "sim/dynamics/gyro.h"
#include "sim/numerics/state_archive.h"
#include "sim/signal/noise.h"
#include "sim/stepper/step_inputs.h"

namespace beamgyro::internal {

/// The random numbers of a gyro that is stepped. They belong to ticks at the
/// times m / rate and hold from one to the next, so they do not depend on where
/// steps end; at ticks they are those of a quasi-static run at this output
/// rate.
class TickNoise {
 public:
  /// `rate` [Hz] is that of the ticks. The numbers of tick 0 are there at once.
  /// Throws as RateNoise.
  TickNoise(const TrimmedGyro& gyro, const StepperStart& start, double rate);

  /// Goes on to the last tick at or before `t` [s]; a tick that only rounding
  /// keeps behind t counts. Throws std::runtime_error, and changes nothing,
  /// where the streams end before.
  void advance_to(double t);

  double rate() const { return rate_; }      // [Hz]
  double output() const { return output_; }  // [rad/s]
  /// Normal numbers of sigma 1, of the temperature sensor and the channels of
  /// the loops.
  double sensor() const { return sensor_; }
  double quadrature() const { return quadrature_; }
  double drive_frequency() const { return drive_frequency_; }
  double drive_voltage() const { return drive_voltage_; }

  void archive(StateArchive& archive);

 private:
  void draw(std::uint64_t ticks);

  double rate_;  // [Hz]
  bool has_sensor_, has_channels_;
  RateNoise output_noise_;
  RandomStream sensor_stream_, quadrature_stream_;
  RandomStream frequency_stream_, voltage_stream_;
  std::uint64_t tick_ = 0;
  double output_ = 0, sensor_ = 0, quadrature_ = 0;
  double drive_frequency_ = 0, drive_voltage_ = 0;
};

}  // namespace beamgyro::internal
