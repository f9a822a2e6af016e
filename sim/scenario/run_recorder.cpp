// SPDX-License-Identifier: MIT
#include "sim/scenario/run_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "config/units.h"
#include "dataset/recording/signals.h"
#include "random/random_stream.h"
#include "sim/memory/bond_relaxation.h"

namespace beamgyro::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Samples = std::vector<double>;

Samples scaled(Samples values, double factor, double offset = 0) {
  for (double& v : values) v = v * factor + offset;
  return values;
}

Samples quantised(Samples values, double factor, double resolution) {
  for (double& v : values) v *= factor;
  quantise(values, resolution);
  return values;
}

// How long the power was off before each cycle [s]: for ever before the first.
Samples off_times(const std::vector<PowerInterval>& powered) {
  Samples off = {std::numeric_limits<double>::infinity()};
  for (std::size_t i = 1; i < powered.size(); ++i)
    off.push_back(powered[i].on - powered[i - 1].off);
  return off;
}

// Says that the noise of a channel hides behind its resolution, where it does.
std::string comment_on_noise(double rms, double resolution,
                             std::string_view unit) {
  if (rms == 0 || rms >= resolution) return {};
  return fmt::format(
      "the noise of {:.2g} {} rms at 25 degC is below the resolution of {:g} "
      "{}",
      rms, unit, resolution, unit);
}

// Appends a column, what is measured without power blanked.
void add(Recording& block, std::string_view name, Samples values,
         std::string comment = {}) {
  Column column = column_of(name, std::move(values));
  column.comment = std::move(comment);
  if (column.role == Role::kMeasured)
    for (std::size_t k = 0; k < column.values.size(); ++k)
      if (block.status[k] & kUnpowered) column.values[k] = kNaN;
  block.columns.push_back(std::move(column));
}

}  // namespace

RunRecorder::RunRecorder(const ScenarioPlan& scenario,
                         const DeviceParameters& device, const RunKey& key,
                         const RunNoise& loop_noise)
    : scenario_(scenario),
      device_(device),
      noise_(with_white_noise(device.noise, loop_noise.sensing),
             scenario.output_rate, scenario.seed, key.device, key.run,
             scenario.has_age ? std::optional(scenario.age) : std::nullopt),
      turn_on_(turn_on_offsets(device.noise, scenario.powered.size(),
                               scenario.seed, key.device, key.run)),
      transients_(turn_on_transients(device.noise, off_times(scenario.powered),
                                     scenario.seed, key.device, key.run)),
      quadrature_sigma_(
          std::sqrt(scenario.output_rate) *
          with_white_noise(device.noise, loop_noise.sensing).angle_random_walk),
      quadrature_stream_(scenario.seed, key.device, key.run,
                         kQuadratureNoiseStream),
      loop_noise_(loop_noise),
      sensor_(device.temperature_sensor, scenario.noise_enabled, scenario.seed,
              key.device, key.run),
      readout_(device.readout.full_scale, device.readout.adc_bits,
               device.readout.scale_factor, device.readout.offset) {}

Recording RunRecorder::block(RunSamples&& samples) {
  Recording block;
  block.fidelity = fidelity_name(scenario_.fidelity);
  block.seed = scenario_.seed;
  block.time = std::move(samples.time);
  if (scenario_.noise_enabled) add_output_noise(block.time, samples.output);
  block.status.assign(block.time.size(), kUnpowered);
  for (const PoweredSamples& part : powered(block.time))
    for (std::size_t k = part.first; k < part.last; ++k) block.status[k] = 0;
  add_measured(block, samples);
  add_truth(block, samples);
  return block;
}

std::vector<RunRecorder::PoweredSamples> RunRecorder::powered(
    const Samples& times) const {
  std::vector<PoweredSamples> parts;
  for (std::size_t i = 0; i < scenario_.powered.size(); ++i) {
    const PowerInterval& interval = scenario_.powered[i];
    const auto first =
        std::lower_bound(times.begin(), times.end(), interval.on);
    const auto last = std::lower_bound(first, times.end(), interval.off);
    parts.push_back({static_cast<std::size_t>(first - times.begin()),
                     static_cast<std::size_t>(last - times.begin()), i});
  }
  return parts;
}

void RunRecorder::add_output_noise(const Samples& times, Samples& output) {
  noise_.add_next(output);
  for (const PoweredSamples& part : powered(times)) {
    const double on = scenario_.powered[part.cycle].on;
    const double transient = transients_[part.cycle];
    for (std::size_t k = part.first; k < part.last; ++k) {
      output[k] += turn_on_[part.cycle];
      if (transient == 0) continue;
      output[k] += transient *
                   std::exp((on - times[k]) / device_.noise.turn_on_settling);
    }
  }
}

void RunRecorder::add_measured(Recording& block, RunSamples& samples) {
  const ReadoutParameters& readout = device_.readout;
  Samples output(block.time.size()), rate(block.time.size());
  for (std::size_t k = 0; k < output.size(); ++k) {
    const ReadoutSample sample = readout_.sample(samples.output[k]);
    output[k] = sample.voltage;
    rate[k] =
        (sample.voltage - readout.offset) / (readout.scale_factor * kDegree);
    if (block.status[k] & kUnpowered) continue;
    if (sample.saturated) block.status[k] |= kOutputSaturated;
    if (!samples.locked[k]) block.status[k] |= kLoopNotLocked;
  }
  add(block, "output", std::move(output));
  add(block, "rate", std::move(rate));
  add(block, "temperature", sensor_.readings(samples.temperature[kSensor]));
  if (device_.loop_channels) return add_loop_channels(block, samples);
  add(block, "drive_frequency",
      quantised(std::move(samples.drive_frequency), 1,
                readout.drive_frequency_resolution));
  add(block, "drive_voltage",
      quantised(std::move(samples.drive_voltage), 1,
                readout.drive_voltage_resolution));
  add(block, "quadrature",
      quantised(std::move(samples.quadrature), 1 / kDegree,
                readout.quadrature_resolution / kDegree));
}

void RunRecorder::add_loop_channels(Recording& block,
                                    const RunSamples& samples) {
  const ReadoutParameters& readout = device_.readout;
  const LoopChannelParameters& channels = *device_.loop_channels;
  const Samples dT =
      scaled(samples.temperature[kBoard], 1, -kCalibrationTemperature);
  Samples noise;
  if (channels.noise && scenario_.noise_enabled) {
    noise.resize(block.time.size());
    quadrature_stream_.fill_normal(noise);
    noise = scaled(std::move(noise), quadrature_sigma_);
  }
  add(block, "drive_frequency",
      quantised(measured_frequency(channels, samples.drive_frequency,
                                   samples.drive_frequency_noise, dT,
                                   scaled(block.time, 1, scenario_.age)),
                1, readout.drive_frequency_resolution),
      comment_on_noise(loop_noise_.drive_frequency,
                       readout.drive_frequency_resolution, "Hz"));
  add(block, "drive_voltage",
      quantised(measured_voltage(channels, samples.drive_voltage,
                                 samples.drive_voltage_noise, dT),
                1, readout.drive_voltage_resolution),
      comment_on_noise(loop_noise_.drive_voltage,
                       readout.drive_voltage_resolution, "V"));
  add(block, "quadrature",
      quantised(measured_quadrature(channels, samples.quadrature, noise, dT),
                1 / kDegree, readout.quadrature_resolution / kDegree),
      comment_on_noise(noise.empty() ? 0 : quadrature_sigma_ / kDegree,
                       readout.quadrature_resolution / kDegree, "degree/s"));
}

void RunRecorder::add_memory(Recording& block,
                             const RunSamples& samples) const {
  const std::size_t count = samples.memory.size();
  Samples glass(count), hysteresis(count);
  for (std::size_t k = 0; k < count; ++k) {
    const MemoryState& state = samples.memory[k];
    glass[k] = reference_fictive_temperature(samples.temperature[kPzt][k],
                                             device_.bond.glass_transition) +
               state.glass_offset - kZeroCelsius;
    hysteresis[k] = state.hysteresis;
  }
  if (device_.memory.relaxation)
    add(block, "true_fictive_temperature", std::move(glass));
  if (device_.memory.hysteresis)
    add(block, "true_hysteresis", std::move(hysteresis));
}

void RunRecorder::add_truth(Recording& block, RunSamples& samples) const {
  for (std::size_t i = 0; i < kAccelerationX; ++i)
    samples.motion[i] = scaled(std::move(samples.motion[i]), 1 / kDegree);
  add(block, "true_rate", std::move(samples.motion[kRateZ]));
  add(block, "true_bias", scaled(std::move(samples.bias), 1 / kDegree));
  if (!samples.spurious_bias.empty())
    add(block, "true_spurious_bias",
        scaled(std::move(samples.spurious_bias), 1 / kDegree));
  if (device_.loop_channels)
    add(block, "true_drive_frequency", std::move(samples.drive_frequency));
  for (std::size_t i = kRateX; i < kCaseAxisCount; ++i)
    if (!samples.motion[i].empty())
      add(block, kCaseAxes[i].column, std::move(samples.motion[i]));
  if (!samples.memory.empty()) add_memory(block, samples);
  for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
    add(block, fmt::format("true_{}_temperature", kThermalNodeNames[node]),
        scaled(std::move(samples.temperature[node]), 1, -kZeroCelsius));
  }
  add(block, "true_ambient_temperature",
      scaled(scenario_.ambient.sample(block.time), 1, -kZeroCelsius));
}

}  // namespace beamgyro::internal
