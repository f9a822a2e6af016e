// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "config/units.h"
#include "sim/memory/bond_relaxation.h"
#include "sim/signal/loop_channels.h"
#include "sim/signal/temperature_sensor.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double GyroStepper::noise_of(const State& state) const {
  if (!noise_) return 0;
  double noise = noise_->output();
  if (!state.powered) return noise;
  const PowerCycle& cycle = state.cycle;
  noise += cycle.offset;
  if (cycle.transient != 0)
    noise +=
        cycle.transient * std::exp((cycle.on - state.time()) /
                                   model_->gyro.device.noise.turn_on_settling);
  return noise;
}

GyroStepper::Channels GyroStepper::channels_of(
    const State& state, const StepSignals& signals) const {
  const DeviceParameters& device = model_->gyro.device;
  const double quadrature = noise_ ? noise_->quadrature() : 0;
  if (!device.loop_channels)
    return {signals.drive_frequency, signals.drive_voltage,
            signals.quadrature + quadrature};
  const LoopChannelParameters& errors = *device.loop_channels;
  const double dT = state.nodes(kBoard) - kCalibrationTemperature;
  const double age = start_.age.value_or(0) + state.time();
  const Eigen::Vector2d drive =
      noise_ ? noise_->drive(state.nodes(kBeam), signals.locked)
             : Eigen::Vector2d::Zero();
  return {
      measured_frequency(errors, signals.drive_frequency, drive(0), dT, age),
      measured_voltage(errors, signals.drive_voltage, drive(1), dT),
      measured_quadrature(errors, signals.quadrature, quadrature, dT)};
}

void GyroStepper::put_measured(const State& state, const StepSignals& signals,
                               StepSample& sample) const {
  const DeviceParameters& device = model_->gyro.device;
  const ReadoutParameters& readout = device.readout;
  const ReadoutSample shown = readout_.sample(signals.output + noise_of(state));
  sample.output = shown.voltage;
  sample.rate =
      (shown.voltage - readout.offset) / (readout.scale_factor * kDegree);
  sample.saturated = shown.saturated;
  sample.temperature = quantise(
      sensed_temperature(device.temperature_sensor, state.nodes(kSensor),
                         noise_ ? noise_->sensor() : 0),
      device.temperature_sensor.resolution);
  const Channels channels = channels_of(state, signals);
  sample.drive_frequency =
      quantise(channels.drive_frequency, readout.drive_frequency_resolution);
  sample.drive_voltage =
      quantise(channels.drive_voltage, readout.drive_voltage_resolution);
  sample.quadrature = quantise(channels.quadrature * (1 / kDegree),
                               readout.quadrature_resolution / kDegree);
}

void GyroStepper::put_truth(const State& state, const StepSignals& signals,
                            StepSample& sample) const {
  const PerAxis<double>& motion = state.inputs.motion;
  sample.true_rate = motion[kRateZ] / kDegree;
  sample.true_cross_rate_x = motion[kRateX] / kDegree;
  sample.true_cross_rate_y = motion[kRateY] / kDegree;
  sample.true_acceleration_x = motion[kAccelerationX];
  sample.true_acceleration_y = motion[kAccelerationY];
  sample.true_acceleration_z = motion[kAccelerationZ];
  sample.true_bias = signals.bias / kDegree;
  const DeviceParameters& device = model_->gyro.device;
  sample.true_spurious_bias =
      device.spurious_modes.empty() ? kNaN : signals.spurious_bias / kDegree;
  sample.true_drive_frequency = signals.drive_frequency;
  sample.true_fictive_temperature = sample.true_hysteresis = kNaN;
  const MemoryState memory = memory_of(state);
  if (device.memory.relaxation)
    sample.true_fictive_temperature =
        reference_fictive_temperature(state.nodes(kPzt),
                                      device.bond.glass_transition) +
        memory.glass_offset - kZeroCelsius;
  if (device.memory.hysteresis) sample.true_hysteresis = memory.hysteresis;
  for (std::size_t i = 0; i < kThermalNodeCount; ++i)
    sample.true_node_temperature[i] =
        state.nodes(static_cast<Eigen::Index>(i)) - kZeroCelsius;
  sample.true_ambient_temperature = state.inputs.ambient - kZeroCelsius;
}

StepSample GyroStepper::sample_of(const State& state,
                                  const StepSignals& signals) const {
  StepSample sample;
  sample.time = state.time();
  sample.powered = state.powered;
  put_truth(state, signals, sample);
  if (state.powered) {
    sample.locked = signals.locked;
    put_measured(state, signals, sample);
    return sample;
  }
  sample.locked = sample.saturated = false;
  sample.output = sample.rate = sample.temperature = sample.drive_frequency =
      sample.drive_voltage = sample.quadrature = kNaN;
  return sample;
}

}  // namespace beamgyro::internal
