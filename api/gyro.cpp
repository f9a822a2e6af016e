// SPDX-License-Identifier: MIT
#include "include/beamgyro/gyro.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "api/program_version.h"
#include "api/reported_progress.h"
#include "api/scenario_state.h"
#include "config/units.h"
#include "dataset/files/sha256.h"
#include "dataset/recording/signals.h"
#include "parallel/work_queue.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro {
namespace {

using internal::kDegree;
using internal::kZeroCelsius;

internal::StepInputs si_inputs(const GyroInputs& inputs) {
  internal::StepInputs si;
  si.motion[internal::kRateZ] = inputs.rate * kDegree;
  si.motion[internal::kRateX] = inputs.cross_rate_x * kDegree;
  si.motion[internal::kRateY] = inputs.cross_rate_y * kDegree;
  si.motion[internal::kAccelerationX] = inputs.acceleration_x;
  si.motion[internal::kAccelerationY] = inputs.acceleration_y;
  si.motion[internal::kAccelerationZ] = inputs.acceleration_z;
  si.ambient = inputs.ambient_temperature + kZeroCelsius;
  return si;
}

std::optional<internal::PiecewiseLinear> history_of(const GyroStart& start) {
  if (start.history.empty()) return {};
  std::vector<double> time, temperature;
  for (const auto& [t, degC] : start.history) {
    time.push_back(t);
    temperature.push_back(degC + kZeroCelsius);
  }
  if (time.back() != 0)
    throw std::invalid_argument(fmt::format(
        "history ends at {:g} s; expected its last point at 0 s, the start",
        time.back()));
  return internal::PiecewiseLinear(std::move(time), std::move(temperature));
}

internal::StepperStart si_start(const GyroStart& start) {
  internal::StepperStart si;
  si.fidelity = internal::step_fidelity(start.fidelity);
  si.seed = start.seed;
  si.noise = start.noise;
  si.noise_rate = start.noise_rate_Hz;
  si.stirred = start.stirred;
  si.inputs = si_inputs(start.inputs);
  si.powered = start.inputs.powered;
  if (start.temperature_degC)
    si.temperatures =
        internal::NodeVector::Constant(*start.temperature_degC + kZeroCelsius);
  if (start.age_hours) si.age = *start.age_hours * 3600;
  si.history = history_of(start);
  return si;
}

GyroSample shown(const internal::StepSample& s) {
  GyroSample sample{.time = s.time,
                    .output = s.output,
                    .rate = s.rate,
                    .temperature = s.temperature,
                    .drive_frequency = s.drive_frequency,
                    .drive_voltage = s.drive_voltage,
                    .quadrature = s.quadrature};
  if (!s.powered) {
    sample.status = kUnpowered;
    return sample;
  }
  if (s.saturated) sample.status |= kOutputSaturated;
  if (!s.locked) sample.status |= kLoopNotLocked;
  return sample;
}

GyroTruth truth_of(const internal::StepSample& s) {
  const auto& node = s.true_node_temperature;
  return {.true_rate = s.true_rate,
          .true_bias = s.true_bias,
          .true_spurious_bias = s.true_spurious_bias,
          .true_drive_frequency = s.true_drive_frequency,
          .true_cross_rate_x = s.true_cross_rate_x,
          .true_cross_rate_y = s.true_cross_rate_y,
          .true_acceleration_x = s.true_acceleration_x,
          .true_acceleration_y = s.true_acceleration_y,
          .true_acceleration_z = s.true_acceleration_z,
          .true_fictive_temperature = s.true_fictive_temperature,
          .true_hysteresis = s.true_hysteresis,
          .true_beam_temperature = node[internal::kBeam],
          .true_pzt_temperature = node[internal::kPzt],
          .true_mount_temperature = node[internal::kMount],
          .true_housing_temperature = node[internal::kHousing],
          .true_board_temperature = node[internal::kBoard],
          .true_sensor_temperature = node[internal::kSensor],
          .true_ambient_temperature = s.true_ambient_temperature};
}

constexpr GyroSignal measured(const char* name, double GyroSample::*value) {
  return {name, value, nullptr};
}
constexpr GyroSignal truth(const char* name, double GyroTruth::*value) {
  return {name, nullptr, value};
}
constexpr std::array kSignals = {
    measured("output", &GyroSample::output),
    measured("rate", &GyroSample::rate),
    measured("temperature", &GyroSample::temperature),
    measured("drive_frequency", &GyroSample::drive_frequency),
    measured("drive_voltage", &GyroSample::drive_voltage),
    measured("quadrature", &GyroSample::quadrature),
    truth("true_rate", &GyroTruth::true_rate),
    truth("true_bias", &GyroTruth::true_bias),
    truth("true_spurious_bias", &GyroTruth::true_spurious_bias),
    truth("true_drive_frequency", &GyroTruth::true_drive_frequency),
    truth("true_cross_rate_x", &GyroTruth::true_cross_rate_x),
    truth("true_cross_rate_y", &GyroTruth::true_cross_rate_y),
    truth("true_acceleration_x", &GyroTruth::true_acceleration_x),
    truth("true_acceleration_y", &GyroTruth::true_acceleration_y),
    truth("true_acceleration_z", &GyroTruth::true_acceleration_z),
    truth("true_fictive_temperature", &GyroTruth::true_fictive_temperature),
    truth("true_hysteresis", &GyroTruth::true_hysteresis),
    truth("true_beam_temperature", &GyroTruth::true_beam_temperature),
    truth("true_pzt_temperature", &GyroTruth::true_pzt_temperature),
    truth("true_mount_temperature", &GyroTruth::true_mount_temperature),
    truth("true_housing_temperature", &GyroTruth::true_housing_temperature),
    truth("true_board_temperature", &GyroTruth::true_board_temperature),
    truth("true_sensor_temperature", &GyroTruth::true_sensor_temperature),
    truth("true_ambient_temperature", &GyroTruth::true_ambient_temperature)};

constexpr std::array kInputs = {
    GyroInputSignal{"rate", "degree/s", &GyroInputs::rate},
    GyroInputSignal{"cross_rate_x", "degree/s", &GyroInputs::cross_rate_x},
    GyroInputSignal{"cross_rate_y", "degree/s", &GyroInputs::cross_rate_y},
    GyroInputSignal{"acceleration_x", "m/s2", &GyroInputs::acceleration_x},
    GyroInputSignal{"acceleration_y", "m/s2", &GyroInputs::acceleration_y},
    GyroInputSignal{"acceleration_z", "m/s2", &GyroInputs::acceleration_z},
    GyroInputSignal{"ambient_temperature", "degC",
                    &GyroInputs::ambient_temperature}};

// Whether a column of a recording is only there where it is not 0 all the time.
bool is_motion(std::string_view name) {
  return name.starts_with("true_cross_rate") ||
         name.starts_with("true_acceleration");
}

// What a gyro does not have, and motions that never move, have no column.
void drop_absent(Recording& recording) {
  std::erase_if(recording.columns, [](const Column& column) {
    return (column.role == Role::kTruth && std::isnan(column.values.front())) ||
           (is_motion(column.name) &&
            std::ranges::all_of(column.values,
                                [](double v) { return v == 0; }));
  });
}

void take_inputs(internal::StateArchive& archive, GyroInputs& inputs) {
  archive(inputs.rate, inputs.cross_rate_x, inputs.cross_rate_y,
          inputs.acceleration_x, inputs.acceleration_y, inputs.acceleration_z,
          inputs.ambient_temperature, inputs.powered);
}

// Puts the number of a step or a gyro before the words of an error.
template <class Work>
void named_by(const char* what, std::size_t number, const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{} {}: {}", what, number, error.what()));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("{} {}: {}", what, number, error.what()));
  }
}

// What the bytes of a state belong to.
std::string state_key(const Device& device, const GyroStart& start) {
  std::string text = device.text();
  for (const std::string& change : device.overrides()) text += "\n" + change;
  const GyroInputs& in = start.inputs;
  text +=
      fmt::format("\n{} {} {} {} {} {} {} {} {} {} {} {} {} {}", start.seed,
                  start.noise, start.noise_rate_Hz, start.stirred, in.rate,
                  in.cross_rate_x, in.cross_rate_y, in.acceleration_x,
                  in.acceleration_y, in.acceleration_z, in.ambient_temperature,
                  in.powered, start.temperature_degC.value_or(std::nan("")),
                  start.age_hours.value_or(std::nan("")));
  for (const auto& [t, degC] : start.history)
    text += fmt::format(" {} {}", t, degC);
  return fmt::format("beamgyro gyro {} {}\n", internal::kGitRevision,
                     internal::sha256(text));
}

}  // namespace

std::span<const GyroInputSignal> gyro_inputs() { return kInputs; }
std::span<const GyroSignal> gyro_signals() { return kSignals; }

struct Gyro::Parts {
  Device device;
  GyroStart start;
  internal::GyroStepper stepper;
  GyroInputs last;  // at the end of the last step
  GyroSample sample = {};
  GyroTruth truth = {};

  void take(const GyroInputs& inputs) {
    last = inputs;
    sample = shown(stepper.now());
    truth = truth_of(stepper.now());
  }
};

Gyro::Gyro(const Device& device, const GyroStart& start)
    : parts_(new Parts{device, start,
                       internal::GyroStepper(internal::stepper_model_of(device),
                                             si_start(start)),
                       start.inputs}) {
  parts_->take(start.inputs);
}
Gyro::Gyro(const Gyro& other) : parts_(new Parts(*other.parts_)) {}
Gyro::Gyro(Gyro&& other) noexcept = default;
Gyro& Gyro::operator=(Gyro other) noexcept {
  std::swap(parts_, other.parts_);
  return *this;
}
Gyro::~Gyro() = default;

const GyroSample& Gyro::now() const { return parts_->sample; }
const GyroTruth& Gyro::truth() const { return parts_->truth; }
const GyroInputs& Gyro::inputs() const { return parts_->last; }
const Device& Gyro::device() const { return parts_->device; }
const GyroStart& Gyro::start() const { return parts_->start; }

const GyroSample& Gyro::step(double duration, const GyroInputs& held) {
  return step(duration, held, held);
}

const GyroSample& Gyro::step(double duration, const GyroInputs& from,
                             const GyroInputs& to) {
  parts_->stepper.step(duration, si_inputs(from), si_inputs(to), to.powered);
  parts_->take(to);
  return parts_->sample;
}

Recording Gyro::advance(double duration, std::span<const GyroInputs> inputs,
                        GyroSteps steps, const Progress& progress) {
  constexpr std::size_t kReported = 16384;  // steps
  if (inputs.empty())
    throw std::invalid_argument("no inputs; expected one for each step");
  Parts next = *parts_;
  Recording recording;
  for (const GyroSignal& signal : kSignals) {
    recording.columns.push_back(internal::column_of(signal.name, {}));
    recording.columns.back().values.reserve(inputs.size());
  }
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    named_by("step", k, [&] {
      const internal::StepInputs to = si_inputs(inputs[k]);
      next.stepper.step(
          duration, steps == GyroSteps::kLinear ? next.stepper.inputs() : to,
          to, inputs[k].powered);
    });
    next.take(inputs[k]);
    recording.time.push_back(next.sample.time);
    recording.status.push_back(next.sample.status);
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      recording.columns[i].values.push_back(
          kSignals[i].of(next.sample, next.truth));
    if ((k + 1) % kReported == 0 || k + 1 == inputs.size())
      internal::report(progress, static_cast<double>(k + 1) /
                                     static_cast<double>(inputs.size()));
  }
  drop_absent(recording);
  recording.fidelity = parts_->start.fidelity;
  recording.seed = parts_->start.seed;
  recording.history = internal::history_line("advance");
  recording.program_version = internal::kProgramVersion;
  recording.git_revision = internal::kGitRevision;
  recording.device_text = parts_->device.text();
  for (const std::string& change : parts_->device.overrides())
    recording.overrides_text += change + "\n";
  parts_ = std::make_unique<Parts>(std::move(next));
  return recording;
}

void step_all(std::span<Gyro* const> gyros, double duration,
              std::span<const GyroInputs> from, std::span<const GyroInputs> to,
              unsigned threads) {
  if (from.size() != gyros.size() || to.size() != gyros.size())
    throw std::invalid_argument(
        fmt::format("{} and {} inputs of {} gyros; expected one of each",
                    from.size(), to.size(), gyros.size()));
  std::vector<const Gyro*> sorted(gyros.begin(), gyros.end());
  std::ranges::sort(sorted);
  if (!sorted.empty() && sorted.front() == nullptr)
    throw std::invalid_argument("a gyro is null; expected one");
  if (std::ranges::adjacent_find(sorted) != sorted.end())
    throw std::invalid_argument(
        "a gyro is there twice; expected different ones");
  // Parts that are worth a thread.
  constexpr std::size_t kPart = 64;
  const std::size_t parts = (gyros.size() + kPart - 1) / kPart;
  const auto each = [&](const auto& work) {
    internal::for_each_task(parts, internal::thread_count(threads),
                            [&](std::size_t part, std::size_t) {
                              const std::size_t end =
                                  std::min(gyros.size(), (part + 1) * kPart);
                              for (std::size_t k = part * kPart; k < end; ++k)
                                work(k);
                            });
  };
  each([&](std::size_t k) {
    named_by("gyro", k, [&] {
      gyros[k]->parts_->stepper.prepare(duration, si_inputs(from[k]),
                                        si_inputs(to[k]), to[k].powered);
    });
  });
  each([&](std::size_t k) {
    gyros[k]->parts_->stepper.commit();
    gyros[k]->parts_->take(to[k]);
  });
}

std::string Gyro::state() const {
  std::string bytes = state_key(parts_->device, parts_->start);
  auto archive = internal::StateArchive::writer(bytes);
  GyroInputs last = parts_->last;
  take_inputs(archive, last);
  return bytes + parts_->stepper.state();
}

void Gyro::restore(std::string_view state) {
  const std::string key = state_key(parts_->device, parts_->start);
  if (!state.starts_with(key))
    throw std::invalid_argument(
        "the bytes are no state of this device, start and program; expected "
        "those that state() has returned for them");
  auto archive = internal::StateArchive::reader(state.substr(key.size()));
  GyroInputs last;
  take_inputs(archive, last);
  parts_->stepper.restore(archive.rest());
  parts_->take(last);
}

}  // namespace beamgyro
