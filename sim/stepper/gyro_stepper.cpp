// SPDX-License-Identifier: MIT
#include "sim/stepper/gyro_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "sim/signal/readout.h"
#include "sim/thermal/material_check.h"

namespace beamgyro::internal {
namespace {

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

void check_noise_rate(double rate) {
  require(rate >= 0 && rate <= 1e6, "the rate of the noise [Hz]", rate,
          "at most 1e6 Hz, or 0: one over the duration of the first step");
}

void check_start(const StepperStart& start) {
  check_inputs(start.inputs);
  check_noise_rate(start.noise_rate);
  if (start.temperatures)
    for (const double T : *start.temperatures)
      require(materials_stand(T), "the temperature of a node [degC]",
              T - kZeroCelsius, "-100 to 150 degC");
  if (start.age)
    require(*start.age >= 0 && *start.age <= 1e9, "the age [s]", *start.age,
            "0 to 1e9 s");
}

std::optional<LoopResponse> loops_of(
    const std::shared_ptr<const StepperModel>& model,
    const StepperStart& start) {
  if (start.fidelity != StepFidelity::kEnvelope) return std::nullopt;
  if (model->gyro.device.memory.any())
    throw std::invalid_argument(
        "the fidelity is that of the envelope, for a gyro that remembers; "
        "expected the quasi-static fidelity, the one in which such a gyro can "
        "be stepped");
  return std::optional<LoopResponse>(std::in_place, model);
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

StepFidelity step_fidelity(std::string_view name) {
  if (name == "quasistatic") return StepFidelity::kQuasistatic;
  if (name == "envelope") return StepFidelity::kEnvelope;
  throw std::invalid_argument(
      fmt::format("fidelity is \"{}\"; expected \"quasistatic\" or "
                  "\"envelope\", in which a gyro can be stepped",
                  name));
}

GyroStepper::GyroStepper(std::shared_ptr<const StepperModel> model,
                         const StepperStart& start)
    : model_(std::move(model)),
      start_(checked(start)),
      thermal_(model_->gyro, start.stirred),
      response_(model_),
      loops_(loops_of(model_, start)),
      readout_(readout_of(model_->gyro.device.readout)),
      state_(first_state()),
      next_(state_) {
  switch_power(state_, start.powered);
  if (start_.noise && start_.noise_rate > 0)
    noise_.emplace(model_, start_, start_.noise_rate, conditions_of(state_));
  sample_ = sample_of(state_, signals_of(state_));
}

GyroStepper::State GyroStepper::first_state() const {
  const DeviceParameters& device = model_->gyro.device;
  const StepperStart& start = start_;
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
  if (loops_) state.loops = loops_->at_rest(temperatures_of(state.nodes));
  return state;
}

void GyroStepper::switch_power(State& state, bool powered) const {
  if (powered == state.powered) return;
  state.powered = powered;
  if (loops_) loops_->stop(*state.loops);
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

void GyroStepper::advance_loops(State& state, double duration,
                                const StepInputs& from, const StepInputs& to) {
  constexpr double kLongest = 1.0;  // [s], between two looks at the materials
  const double electronics = model_->gyro.device.thermal.electronics_power;
  const auto parts =
      static_cast<std::int64_t>(std::max(1.0, std::ceil(duration / kLongest)));
  const double start = state.time();
  const auto at = [&](std::int64_t i) {
    const double share = static_cast<double>(i) / static_cast<double>(parts);
    StepInputs inputs;
    for (std::size_t k = 0; k < kCaseAxisCount; ++k)
      inputs.motion[k] = std::lerp(from.motion[k], to.motion[k], share);
    inputs.ambient = std::lerp(from.ambient, to.ambient, share);
    return inputs;
  };
  const double part = duration / static_cast<double>(parts);
  for (std::int64_t i = 0; i < parts; ++i) {
    const double begin = start + static_cast<double>(i) * part;
    const StepInputs after = at(i + 1);
    loops_->advance(*state.loops,
                    {begin, part, at(i), after, state.powered, start_.stirred});
    check_materials(begin + part, LoopResponse::nodes(*state.loops),
                    after.ambient, electronics);
  }
  state.nodes.head<kThermalNodeCount>() = LoopResponse::nodes(*state.loops);
}

const StepSample& GyroStepper::step(double duration, const StepInputs& from,
                                    const StepInputs& to, bool powered) {
  prepare(duration, from, to, powered);
  return commit();
}

void GyroStepper::prepare(double duration, const StepInputs& from,
                          const StepInputs& to, bool powered) {
  if (!(duration > 0 && duration <= kLongestGyroStep))
    throw std::invalid_argument(
        fmt::format("the duration of a step is {:g} s; expected above 0, at "
                    "most {:g} s",
                    duration, kLongestGyroStep));
  check_inputs(from);
  check_inputs(to);
  next_ = state_;
  switch_power(next_, powered);
  if (loops_)
    advance_loops(next_, duration, from, to);
  else
    heat(next_, duration, from, to);
  next_.motion.advance(from.motion, to.motion, duration);
  next_.inputs = to;
  next_.pass(duration);
  next_signals_ = signals_of(next_);
  if (!start_.noise) return;
  if (!noise_) check_noise_rate(1 / duration);
  TickNoise::last_tick(noise_ ? noise_->rate() : 1 / duration, next_.time());
}

const StepSample& GyroStepper::commit() {
  if (start_.noise) {
    NoiseConditions before = conditions_of(state_);
    if (!noise_) noise_.emplace(model_, start_, 1 / next_.duration, before);
    if (next_.powered != state_.powered) {
      before.powered = next_.powered;
      noise_->switch_power(state_.time(), before);
    }
    noise_->advance_to(next_.time(), conditions_of(next_));
  }
  sample_ = sample_of(next_, next_signals_);
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

NoiseConditions GyroStepper::conditions_of(const State& state) {
  return {state.nodes(kBeam), state.nodes(kBoard), state.powered};
}

// Without power a gyro has no output; its bias is the one that it would settle
// to.
StepSignals GyroStepper::loop_signals_of(const State& state) {
  const NodeVector nodes = temperatures_of(state.nodes);
  StepSignals signals = loops_->at(state.time(), *state.loops, state.powered);
  if (!state.powered)
    signals.bias =
        response_.at(state.time(), nodes, {}, state.motion, false).bias;
  if (!model_->gyro.device.spurious_modes.empty()) {
    const CaseFilter still(model_->gyro.device.readout.corner_frequency, {});
    signals.spurious_bias =
        response_.at(state.time(), nodes, {}, still, false).spurious_bias;
  }
  return signals;
}

StepSignals GyroStepper::signals_of(const State& state) {
  if (loops_) return loop_signals_of(state);
  return response_.at(state.time(), temperatures_of(state.nodes),
                      memory_of(state), state.motion, state.powered);
}

MemoryState GyroStepper::memory_of(const State& state) {
  return state.memory ? state.memory->state(state.nodes(kPzt)) : MemoryState{};
}

void GyroStepper::State::archive(StateArchive& archive) {
  archive(start, duration, steps);
  for (double& y : nodes) archive(y);
  archive(inputs.motion, inputs.ambient, powered, motion, cycle.number,
          cycle.on, cycle.off, cycle.offset, cycle.transient);
  if (memory) archive(*memory);
  if (loops) archive(*loops);
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
    noise.emplace(model_, start_, noise_rate, conditions_of(state));
    archive(*noise);
  }
  if (!archive.rest().empty())
    throw std::invalid_argument("the bytes of the state do not end with it");
  const StepSignals signals = signals_of(state);
  std::swap(noise_, noise);
  state_ = state;
  sample_ = sample_of(state_, signals);
}

}  // namespace beamgyro::internal
