// SPDX-License-Identifier: MIT
#include "sim/scenario/sensing_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "random/random_stream.h"
#include "sim/dynamics/loop_noise.h"

namespace beamgyro::internal {

bool has_channel_noise(const ScenarioPlan& scenario,
                       const DeviceParameters& device) {
  return scenario.noise_enabled && device.loop_channels &&
         device.loop_channels->noise;
}

SensingNoise::SensingNoise(const ScenarioPlan& scenario,
                           const TrimmedGyro& gyro, const RunKey& key)
    : scenario_(scenario),
      gyro_(gyro),
      ode_(gyro, drive_heating(gyro)),
      key_(key) {}

void SensingNoise::add_next(RunSamples& samples) {
  const bool channels = has_channel_noise(scenario_, gyro_.device);
  const Eigen::Matrix2Xd rows = drive_channels(ode_.loops());
  if (channels) {
    samples.drive_frequency_noise.assign(samples.time.size(), 0);
    samples.drive_voltage_noise.assign(samples.time.size(), 0);
  }
  for (std::size_t k = 0; k < samples.time.size(); ++k) {
    if (!powered_at(scenario_.powered, samples.time[k])) continue;
    const double beam = samples.temperature[kBeam][k];
    const double board = samples.temperature[kBoard][k];
    if (!noise_) {
      noise_.emplace(loop_noise(gyro_, ode_, beam, board),
                     1 / scenario_.output_rate,
                     RandomStream(scenario_.seed, key_.device, key_.run,
                                  kMechanicalNoiseStream));
      beam_ = beam, board_ = board;
    } else {
      if (std::abs(beam - beam_) > kNoiseRefresh ||
          std::abs(board - board_) > kNoiseRefresh) {
        noise_->refresh(loop_noise(gyro_, ode_, beam, board));
        beam_ = beam, board_ = board;
      }
      noise_->advance();
    }
    samples.output[k] += noise_->state()(kOutput2);
    samples.quadrature[k] -= noise_->state()(kOutput2 + 1);
    if (!channels) continue;
    const Eigen::Vector2d drive = rows * noise_->state();
    samples.drive_frequency_noise[k] = drive(0);
    if (samples.locked[k]) samples.drive_voltage_noise[k] = drive(1);
  }
}

RunNoise SensingNoise::rms() {
  if (!has_channel_noise(scenario_, gyro_.device)) return {};
  const Eigen::Vector2d rms = drive_noise_rms(
      ode_.loops(), loop_noise(gyro_, ode_, kCalibrationTemperature,
                               kCalibrationTemperature));
  return {.drive_frequency = rms(0), .drive_voltage = rms(1)};
}

SlowDriveNoise::SlowDriveNoise(const ScenarioPlan& scenario,
                               const TrimmedGyro& gyro,
                               const TemperatureSpan& beam, const RunKey& key)
    : frequency_stream_(scenario.seed, key.device, key.run,
                        kDriveFrequencyNoiseStream),
      voltage_stream_(scenario.seed, key.device, key.run,
                      kDriveVoltageNoiseStream),
      table_(gyro, beam.low, beam.high, scenario.output_rate) {}

void SlowDriveNoise::add_next(RunSamples& samples) {
  const std::size_t count = samples.time.size();
  samples.drive_frequency_noise.resize(count);
  samples.drive_voltage_noise.resize(count);
  frequency_stream_.fill_normal(samples.drive_frequency_noise);
  voltage_stream_.fill_normal(samples.drive_voltage_noise);
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d sigma = table_.at(samples.temperature[kBeam][k]);
    samples.drive_frequency_noise[k] *= sigma(0);
    samples.drive_voltage_noise[k] *= samples.locked[k] ? sigma(1) : 0;
  }
}

RunNoise SlowDriveNoise::rms() const {
  return {.drive_frequency = table_.at_trim()(0),
          .drive_voltage = table_.at_trim()(1)};
}

}  // namespace beamgyro::internal
