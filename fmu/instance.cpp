// SPDX-License-Identifier: MIT
#include "fmu/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kHour = 3600;  // [s]

using enum FmuPhase;

const char* name_of(FmuPhase phase) {
  switch (phase) {
    case kInstantiated:
      return "before initialization";
    case kInitialization:
      return "in initialization";
    case kStepping:
      return "between steps";
    case kTerminated:
      break;
  }
  return "after the end";
}

FmuSettings default_settings(const PackedDevice& device) {
  FmuSettings settings;
  settings.inputs.back() = 25;  // [degC]
  for (const DeviceKey& key : device.keys()) settings.keys.push_back(key.value);
  return settings;
}

StepInputs si_inputs_of(const std::array<double, kRealInputs>& inputs) {
  StepInputs si;
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    si.motion[i] = i < kAccelerationX ? inputs[i] * kDegree : inputs[i];
  si.ambient = inputs.back() + kZeroCelsius;
  return si;
}

void require_in_range(const FmuVariable& about, double value) {
  const Range range{about.low, about.high, about.low_open, about.high_open};
  if (!range.contains(value))
    throw std::invalid_argument(fmt::format("{} is {:g}; expected {}",
                                            about.name, value, text_of(range)));
}

bool is_input(std::uint32_t reference) {
  return reference >= kFirstInput && reference < kFirstInput + kRealInputs;
}

}  // namespace

FmuInstance::FmuInstance(PackedDevice device, FmiVersion version,
                         std::string_view token)
    : device_(std::move(device)),
      variables_(fmu_variables(device_, version)),
      by_reference_(kFirstSignal + kSignalCount) {
  if (token != device_.token())
    throw std::invalid_argument(fmt::format(
        "the token is \"{}\"; expected that of the device in the resources, "
        "{}",
        token, device_.token()));
  for (const FmuVariable& variable : variables_)
    if (variable.reference < kFirstKey)
      by_reference_[variable.reference] = &variable;
  reset();
}

const FmuVariable& FmuInstance::variable(std::uint32_t reference,
                                         VariableType type) const {
  const FmuVariable* found = nullptr;
  if (reference < by_reference_.size())
    found = by_reference_[reference];
  else if (reference >= kFirstKey &&
           reference - kFirstKey < device_.keys().size())
    found = &variables_[variables_.size() - device_.keys().size() +
                        (reference - kFirstKey)];
  if (found == nullptr)
    throw std::invalid_argument(fmt::format(
        "no variable has the value reference {}; expected one of the model "
        "description",
        reference));
  if (found->type != type)
    throw std::invalid_argument(
        fmt::format("{} (value reference {}) is of another type; expected the "
                    "functions of its type",
                    found->name, reference));
  return *found;
}

const FmuVariable& FmuInstance::settable(std::uint32_t reference,
                                         VariableType type) const {
  const FmuVariable& found = variable(reference, type);
  if (found.causality == Causality::kInput && state_->phase != kTerminated)
    return found;
  if (found.causality == Causality::kParameter &&
      (state_->phase == kInstantiated || state_->phase == kInitialization))
    return found;
  throw std::invalid_argument(fmt::format(
      "{} cannot be set {}; expected {}", found.name, name_of(state_->phase),
      found.causality == Causality::kParameter
          ? "a parameter before the end of initialization"
          : "an input, or a parameter before the end of initialization"));
}

void FmuInstance::require_phase(std::initializer_list<FmuPhase> phases,
                                const char* call) const {
  if (std::ranges::find(phases, state_->phase) != phases.end()) return;
  throw std::invalid_argument(
      fmt::format("{} is not allowed {}; expected it {}", call,
                  name_of(state_->phase), name_of(*phases.begin())));
}

void FmuInstance::set_up(double start, std::optional<double> stop) {
  require_phase({kInstantiated}, "the set-up of the experiment");
  if (!std::isfinite(start) || (stop && !(*stop >= start)))
    throw std::invalid_argument(fmt::format(
        "the experiment goes from {:g} to {:g} s; expected a finite start and "
        "a stop that is no earlier",
        start, stop.value_or(start)));
  state_->start = start;
  state_->stop = stop;
}

void FmuInstance::enter_initialization() {
  require_phase({kInstantiated}, "the begin of initialization");
  state_->phase = kInitialization;
}

void FmuInstance::exit_initialization() {
  require_phase({kInitialization}, "the end of initialization");
  start_stepper();
  state_->phase = kStepping;
}

void FmuInstance::terminate() {
  require_phase({kStepping}, "the end");
  state_->phase = kTerminated;
}

void FmuInstance::reset() {
  auto first = std::make_unique<State>();
  first->settings = default_settings(device_);
  state_ = std::move(first);
}

double FmuInstance::time() const {
  return state_->stepper ? state_->start + state_->stepper->time()
                         : state_->start;
}

void FmuInstance::step(double time, double size) {
  require_phase({kStepping}, "a step");
  const double now = this->time();
  if (!(size > 0) || !std::isfinite(size))
    throw std::invalid_argument(fmt::format(
        "the step size is {:g} s; expected a finite one above 0", size));
  // What sums of steps round away.
  const double rounding =
      std::min(1e-9 * std::max(1.0, std::abs(now)), size / 2);
  if (!(std::abs(time - now) <= rounding))
    throw std::invalid_argument(fmt::format(
        "the step begins at {} s; expected {} s, where the last one ended",
        time, now));
  if (state_->stop && now + size > *state_->stop + rounding)
    throw std::invalid_argument(
        fmt::format("the step ends at {} s; expected no later than the stop "
                    "time, {} s",
                    now + size, *state_->stop));
  FmuSettings& settings = state_->settings;
  std::array<double, kRealInputs> end = settings.inputs;
  for (std::size_t i = 0; i < end.size(); ++i)
    end[i] += settings.slopes[i] * size;
  state_->stepper->step(size, si_inputs_of(settings.inputs), si_inputs_of(end),
                        settings.powered);
  settings.inputs = end;
  settings.slopes = {};
}

GyroStepper FmuInstance::stepper_of(const FmuSettings& settings) {
  if (model_ == nullptr || model_keys_ != settings.keys) {
    model_ = stepper_model(make_gyro(device_.with(settings.keys)));
    model_keys_ = settings.keys;
  }
  StepperStart start{.fidelity = device_.fidelity(),
                     .seed = settings.seed,
                     .noise = settings.noise,
                     .noise_rate = settings.noise_rate,
                     .stirred = settings.stirred,
                     .inputs = si_inputs_of(settings.inputs),
                     .powered = settings.powered,
                     .age = settings.age * kHour};
  if (!settings.starts_at_ambient)
    start.temperatures =
        NodeVector::Constant(settings.start_temperature + kZeroCelsius);
  return {model_, start};
}

void FmuInstance::start_stepper() {
  if (state_->stepper) return;
  state_->stepper.emplace(stepper_of(state_->settings));
  state_->first = state_->settings;
}

// What is shown in initialization follows from the settings.
void FmuInstance::note_change() {
  if (state_->phase != kStepping) state_->stepper.reset();
}

double FmuInstance::real(std::uint32_t reference) const {
  const FmuSettings& settings = state_->settings;
  if (reference >= kFirstKey) return settings.keys[reference - kFirstKey];
  if (is_input(reference)) return settings.inputs[reference - kFirstInput];
  switch (reference) {
    case kTimeReference:
      return time();
    case kNoiseRate:
      return settings.noise_rate;
    case kAge:
      return settings.age;
    case kStartTemperature:
      return settings.start_temperature;
    default:
      return sampled_signal(reference, state_->stepper->now());
  }
}

void FmuInstance::put_real(std::uint32_t reference, double value) {
  FmuSettings& settings = state_->settings;
  if (reference >= kFirstKey)
    settings.keys[reference - kFirstKey] = value;
  else if (is_input(reference))
    settings.inputs[reference - kFirstInput] = value;
  else if (reference == kNoiseRate)
    settings.noise_rate = value;
  else if (reference == kAge)
    settings.age = value;
  else
    settings.start_temperature = value;
}

void FmuInstance::get_reals(std::span<const std::uint32_t> references,
                            double* values) {
  for (const std::uint32_t reference : references)
    if (variable(reference, VariableType::kReal).reference >= kFirstSignal &&
        reference < kFirstKey)
      require_signals();
  for (std::size_t i = 0; i < references.size(); ++i)
    values[i] = real(references[i]);
}

void FmuInstance::require_signals() {
  require_phase({kInitialization, kStepping, kTerminated},
                "a look at a signal");
  start_stepper();
}

void FmuInstance::get_integers(std::span<const std::uint32_t> references,
                               std::int32_t* values) {
  for (const std::uint32_t reference : references) {
    variable(reference, VariableType::kInteger);
    if (reference == kStatus) require_signals();
  }
  for (std::size_t i = 0; i < references.size(); ++i)
    values[i] = integer(references[i]);
}

std::int32_t FmuInstance::integer(std::uint32_t reference) const {
  if (reference == kStatus) return status_of(state_->stepper->now());
  if (reference == kSeed || reference == kSeedHigh)
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(
        state_->settings.seed >> (reference == kSeed ? 0 : 32)));
  return static_cast<std::int32_t>(
      state_->settings.keys[reference - kFirstKey]);
}

void FmuInstance::put_integer(std::uint32_t reference, std::int32_t value) {
  constexpr std::uint64_t kLow = 0xffffffff;
  std::uint64_t& seed = state_->settings.seed;
  const std::uint64_t half = static_cast<std::uint32_t>(value);
  if (reference == kSeed)
    seed = (seed & ~kLow) | half;
  else if (reference == kSeedHigh)
    seed = (seed & kLow) | half << 32;
  else
    state_->settings.keys[reference - kFirstKey] = value;
}

bool FmuInstance::get_boolean(std::uint32_t reference) {
  variable(reference, VariableType::kBoolean);
  return flag(reference);
}

bool& FmuInstance::flag(std::uint32_t reference) {
  FmuSettings& settings = state_->settings;
  switch (reference) {
    case kPowered:
      return settings.powered;
    case kNoise:
      return settings.noise;
    case kStirred:
      return settings.stirred;
    default:
      return settings.starts_at_ambient;
  }
}

std::uint64_t FmuInstance::get_unsigned64(std::uint32_t reference) const {
  variable(reference, VariableType::kUnsigned64);
  return state_->settings.seed;
}

void FmuInstance::set_reals(std::span<const std::uint32_t> references,
                            const double* values) {
  for (std::size_t i = 0; i < references.size(); ++i)
    require_in_range(settable(references[i], VariableType::kReal), values[i]);
  for (std::size_t i = 0; i < references.size(); ++i)
    put_real(references[i], values[i]);
  note_change();
}

void FmuInstance::set_integers(std::span<const std::uint32_t> references,
                               const std::int32_t* values) {
  for (std::size_t i = 0; i < references.size(); ++i)
    require_in_range(settable(references[i], VariableType::kInteger),
                     values[i]);
  for (std::size_t i = 0; i < references.size(); ++i)
    put_integer(references[i], values[i]);
  note_change();
}

void FmuInstance::set_booleans(std::span<const std::uint32_t> references,
                               const bool* values) {
  for (const std::uint32_t reference : references)
    settable(reference, VariableType::kBoolean);
  for (std::size_t i = 0; i < references.size(); ++i)
    flag(references[i]) = values[i];
  note_change();
}

void FmuInstance::set_unsigned64(std::uint32_t reference, std::uint64_t value) {
  settable(reference, VariableType::kUnsigned64);
  state_->settings.seed = value;
  note_change();
}

void FmuInstance::set_slopes(std::span<const std::uint32_t> references,
                             const std::int32_t* orders, const double* values) {
  require_phase({kStepping}, "a derivative of an input");
  for (std::size_t i = 0; i < references.size(); ++i) {
    const FmuVariable& about = settable(references[i], VariableType::kReal);
    if (orders[i] != 1 || !std::isfinite(values[i]))
      throw std::invalid_argument(fmt::format(
          "the derivative {} of {} is {:g}; expected a finite one of order 1",
          orders[i], about.name, values[i]));
  }
  for (std::size_t i = 0; i < references.size(); ++i)
    state_->settings.slopes[references[i] - kFirstInput] = values[i];
}

}  // namespace beamgyro::internal
