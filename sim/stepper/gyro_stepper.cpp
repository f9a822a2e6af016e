// SPDX-License-Identifier: MIT
#include "sim/stepper/gyro_stepper.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "sim/dynamics/mechanical_noise.h"
#include "sim/memory/bond_relaxation.h"
#include "sim/signal/loop_channels.h"
#include "sim/signal/readout.h"
#include "sim/signal/temperature_sensor.h"
#include "sim/thermal/material_check.h"

namespace beamgyro::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

NodeVector temperatures_of(const ThermalStepper::State& nodes) {
  return nodes.head<kThermalNodeCount>();
}

void require(bool holds, const char* what, double value, const char* expected) {
  if (!holds)
    throw std::invalid_argument(
        fmt::format("{} is {:g}; expected {}", what, value, expected));
}

void check_inputs(const StepInputs& inputs) {
  constexpr double kMostRate = 1e4 * kDegree, kMostAcceleration = 1e6;
  for (std::size_t i = 0; i < kCaseAxisCount; ++i) {
    const double value = inputs.motion[i];
    if (i < kAccelerationX)
      require(std::abs(value) <= kMostRate, "a rate [deg/s]", value / kDegree,
              "at most 1e4 deg/s");
    else
      require(std::abs(value) <= kMostAcceleration, "an acceleration [m/s2]",
              value, "at most 1e6 m/s2");
  }
  require(materials_stand(inputs.ambient), "the ambient temperature [degC]",
          inputs.ambient - kZeroCelsius, "-100 to 150 degC");
}

void check_start(const StepperStart& start) {
  check_inputs(start.inputs);
  require(start.noise_rate >= 0 && start.noise_rate <= 1e6,
          "the rate of the noise [Hz]", start.noise_rate,
          "0 (that of the first step) to 1e6 Hz");
  if (start.temperatures)
    for (const double T : *start.temperatures)
      require(materials_stand(T), "the temperature of a node [degC]",
              T - kZeroCelsius, "-100 to 150 degC");
  if (start.age)
    require(*start.age >= 0 && *start.age <= 1e9, "the age [s]", *start.age,
            "0 to 1e9 s");
}

StepperStart checked(const StepperStart& start) {
  check_start(start);
  return start;
}

double number_of(const StepperStart& start, RandomPurpose purpose,
                 std::int64_t number) {
  RandomStream stream(start.seed, start.device, start.run, purpose);
  stream.seek(static_cast<std::uint64_t>(number));
  return stream.normal();
}

Readout readout_of(const ReadoutParameters& readout) {
  return {readout.full_scale, readout.adc_bits, readout.scale_factor,
          readout.offset};
}

}  // namespace

GyroStepper::GyroStepper(std::shared_ptr<const StepperModel> model,
                         const StepperStart& start)
    : model_(std::move(model)),
      start_(checked(start)),
      thermal_(model_->gyro, start.stirred),
      response_(model_),
      readout_(readout_of(model_->gyro.device.readout)),
      white_noise_(output_noise(model_->gyro).angle_random_walk),
      state_(first_state(model_->gyro, start)),
      next_(state_) {
  switch_power(state_, start.powered);
  if (start_.noise && start_.noise_rate > 0)
    noise_.emplace(model_->gyro, start_, start_.noise_rate);
  sample_ = sample_of(state_, signals_of(state_));
}

GyroStepper::State GyroStepper::first_state(const TrimmedGyro& gyro,
                                            const StepperStart& start) {
  const DeviceParameters& device = gyro.device;
  State state{.nodes = ThermalStepper::State::Zero(),
              .inputs = start.inputs,
              .powered = false,
              .motion = CaseFilter(device.readout.corner_frequency,
                                   start.inputs.motion)};
  state.nodes.head<kThermalNodeCount>() =
      start.temperatures.value_or(NodeVector::Constant(start.inputs.ambient));
  if (device.memory.any()) {
    state.memory.emplace(device.memory, device.bond.glass_transition,
                         UnitHistory{start.history, start.age.value_or(0)},
                         state.nodes(kPzt));
    state.memory->push_beam(state.nodes(kBeam));
  }
  return state;
}

void GyroStepper::switch_power(State& state, bool powered) const {
  if (powered == state.powered) return;
  state.powered = powered;
  PowerCycle& cycle = state.cycle;
  const double now = state.time();
  if (!powered) {
    cycle.off = now;
    return;
  }
  const double off_time = cycle.number < 0
                              ? std::numeric_limits<double>::infinity()
                              : now - cycle.off;
  ++cycle.number;
  cycle.on = now;
  state.nodes(kThermalNodeCount) = 0;  // the integral of an oven
  if (!start_.noise) return;
  const NoiseParameters& noise = model_->gyro.device.noise;
  cycle.offset = noise.turn_on * number_of(start_, kTurnOnStream, cycle.number);
  cycle.transient = noise.turn_on_transient *
                    number_of(start_, kTurnOnTransientStream, cycle.number) *
                    recovered_transient(noise, off_time);
}

void GyroStepper::heat(State& state, double duration, const StepInputs& from,
                       const StepInputs& to) const {
  const double electronics = model_->gyro.device.thermal.electronics_power;
  const std::int64_t parts = thermal_.parts(duration);
  const double part = duration / static_cast<double>(parts);
  double before = from.ambient;
  for (std::int64_t i = 1; i <= parts; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(parts);
    const double after = std::lerp(from.ambient, to.ambient, share);
    const double patches = state.nodes(kPzt);
    state.nodes =
        thermal_.stepped(state.nodes, before, after, state.powered, part);
    before = after;
    check_materials(state.time() + share * duration,
                    temperatures_of(state.nodes), after, electronics);
    if (!state.memory) continue;
    state.memory->advance_patches(patches, state.nodes(kPzt), part);
    state.memory->push_beam(state.nodes(kBeam));
  }
}

const StepSample& GyroStepper::step(double duration, const StepInputs& from,
                                    const StepInputs& to, bool powered) {
  if (!(duration > 0 && duration <= kLongestStep))
    throw std::invalid_argument(
        fmt::format("the duration of a step is {:g} s; expected above 0, at "
                    "most {:g} s",
                    duration, kLongestStep));
  check_inputs(from);
  check_inputs(to);
  next_ = state_;
  switch_power(next_, powered);
  heat(next_, duration, from, to);
  next_.motion.advance(from.motion, to.motion, duration);
  next_.inputs = to;
  next_.pass(duration);
  const StepSignals signals = signals_of(next_);
  if (start_.noise) {
    if (!noise_) noise_.emplace(model_->gyro, start_, 1 / duration);
    noise_->advance_to(next_.time());
  }
  sample_ = sample_of(next_, signals);
  state_ = next_;
  return sample_;
}

void GyroStepper::State::pass(double step) {
  if (step != duration) {
    start = time();
    duration = step;
    steps = 0;
  }
  ++steps;
}

StepSignals GyroStepper::signals_of(const State& state) {
  return response_.at(state.time(), temperatures_of(state.nodes),
                      memory_of(state), state.motion, state.powered);
}

MemoryState GyroStepper::memory_of(const State& state) {
  return state.memory ? state.memory->state(state.nodes(kPzt)) : MemoryState{};
}

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
  if (!device.loop_channels)
    return {signals.drive_frequency, signals.drive_voltage, signals.quadrature};
  const LoopChannelParameters& errors = *device.loop_channels;
  const double dT = state.nodes(kBoard) - kCalibrationTemperature;
  const double age = start_.age.value_or(0) + state.time();
  Eigen::Vector2d drive = Eigen::Vector2d::Zero();
  double quadrature = 0;
  if (noise_ && errors.noise) {
    const double root = std::sqrt(noise_->rate());
    drive = root * model_->drive_noise->at(state.nodes(kBeam));
    drive(0) *= noise_->drive_frequency();
    drive(1) *= signals.locked ? noise_->drive_voltage() : 0;
    quadrature = root * white_noise_ * noise_->quadrature();
  }
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

void GyroStepper::State::archive(StateArchive& archive) {
  archive(start, duration, steps);
  for (double& y : nodes) archive(y);
  archive(inputs.motion, inputs.ambient, powered, motion, cycle.number,
          cycle.on, cycle.off, cycle.offset, cycle.transient);
  if (memory) archive(*memory);
}

std::string GyroStepper::state() const {
  std::string bytes;
  StateArchive archive = StateArchive::writer(bytes);
  State state = state_;
  std::optional<TickNoise> noise = noise_;
  double noise_rate = noise ? noise->rate() : 0;
  archive(state, noise_rate);
  if (noise) archive(*noise);
  return bytes;
}

void GyroStepper::restore(std::string_view bytes) {
  StateArchive archive = StateArchive::reader(bytes);
  State state = state_;
  double noise_rate = 0;
  archive(state, noise_rate);
  std::optional<TickNoise> noise;
  if (start_.noise && noise_rate > 0) {
    noise.emplace(model_->gyro, start_, noise_rate);
    archive(*noise);
  }
  if (!archive.at_end())
    throw std::invalid_argument("the bytes of the state do not end with it");
  const StepSignals signals = signals_of(state);
  std::swap(noise_, noise);
  state_ = state;
  sample_ = sample_of(state_, signals);
}

}  // namespace beamgyro::internal
