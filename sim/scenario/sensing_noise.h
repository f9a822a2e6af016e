// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "sim/dynamics/drive_noise_table.h"
#include "sim/dynamics/envelope.h"
#include "sim/scenario/run_recorder.h"
#include "sim/signal/linear_noise.h"
#include "sim/thermal/thermal_trajectory.h"

namespace beamgyro::internal {

/// Returns whether the channels of the drive loop carry noise in this run.
bool has_channel_noise(const ScenarioPlan& scenario,
                       const DeviceParameters& device);

/// Noise of mechanics and charge amplifiers behind loops and filters
/// (loop_noise()), exact at the sample times. The coefficients follow the
/// temperatures in steps of kNoiseRefresh. Without power the state does not
/// advance.
class SensingNoise {
 public:
  /// `scenario` and `gyro` must outlive it.
  SensingNoise(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
               const RunKey& key);

  /// Adds the noise to output and quadrature of the next samples and, where
  /// the channels carry noise, writes that of drive frequency and voltage. A
  /// voltage at its limit has none.
  void add_next(RunSamples& samples);

  /// Rms of the channels of the drive loop, with beam and board at T_0.
  RunNoise rms();

 private:
  const ScenarioPlan& scenario_;
  const TrimmedGyro& gyro_;
  EnvelopeOde ode_;
  RunKey key_;
  std::optional<LinearNoise> noise_;
  double beam_ = 0, board_ = 0;  // of the coefficients [K]
};

/// Noise of drive frequency and voltage for runs that do not simulate the
/// loops: white, with the density that SensingNoise has well below their
/// bandwidth (DriveNoiseTable).
class SlowDriveNoise {
 public:
  /// `beam` holds all temperatures of the beam.
  SlowDriveNoise(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                 const TemperatureSpan& beam, const RunKey& key);

  /// Writes the noise of the next samples.
  void add_next(RunSamples& samples);

  /// Rms of a sample, with beam and board at T_0.
  RunNoise rms() const;

 private:
  RandomStream frequency_stream_, voltage_stream_;
  DriveNoiseTable table_;
};

}  // namespace beamgyro::internal
