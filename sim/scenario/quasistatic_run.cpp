// SPDX-License-Identifier: MIT
#include "sim/scenario/quasistatic_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim/dynamics/static_map.h"
#include "sim/signal/noise.h"
#include "sim/signal/readout.h"
#include "sim/signal/temperature_sensor.h"

namespace beamgyro {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kZeroCelsius = 273.15;             // [K]
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Samples = std::vector<double>;

// Power cycle of every sample, -1 while unpowered.
std::vector<int> power_cycles(const Scenario& scenario, const Samples& times) {
  std::vector<int> cycle(times.size(), -1);
  for (std::size_t i = 0; i < scenario.powered.size(); ++i) {
    const PowerInterval& interval = scenario.powered[i];
    const auto first =
        std::lower_bound(times.begin(), times.end(), interval.on);
    const auto last = std::lower_bound(first, times.end(), interval.off);
    std::fill(cycle.begin() + (first - times.begin()),
              cycle.begin() + (last - times.begin()), static_cast<int>(i));
  }
  return cycle;
}

// Heat the drive makes at T_0: 1/2 c w^2 A^2 in the beam and
// 1/2 w C V^2 tan(delta) in the driven patch [W].
void add_drive_heating(const Gyro& gyro, ThermalLoad& load) {
  const ModalParameters modal = modal_parameters(
      gyro.device, gyro.beam, kCalibrationTemperature, gyro.stiffness_trim);
  const BeamSignal signal = beam_signal(gyro, modal, {});
  const double w = signal.drive_frequency;
  const double velocity = w * gyro.device.drive.amplitude;
  load.mechanical_power = 0.5 * modal.damping(0, 0) * velocity * velocity;
  load.dielectric_power =
      0.5 * w *
      patch_capacitance(gyro.device.patches, kCalibrationTemperature) *
      signal.drive_voltage * signal.drive_voltage *
      gyro.device.patches.loss_tangent;
}

ThermalHistory temperatures(const Scenario& scenario, const Gyro& gyro,
                            const Samples& times) {
  ThermalLoad load{.ambient = scenario.ambient,
                   .stirred = scenario.stirred,
                   .powered = scenario.powered};
  add_drive_heating(gyro, load);
  return simulate_temperatures(ThermalNetwork(gyro.device.thermal), load,
                               times);
}

// Rate-equivalent signals of every sample, SI, before noise and readout.
struct Signals {
  Samples output, quadrature, bias;        // [rad/s]
  Samples drive_frequency, drive_voltage;  // [Hz V]
  std::vector<bool> locked;

  explicit Signals(std::size_t count)
      : output(count),
        quadrature(count),
        bias(count),
        drive_frequency(count),
        drive_voltage(count),
        locked(count) {}
};

Signals deterministic_signals(const Gyro& gyro, const ThermalHistory& thermal,
                              const Samples& rate) {
  const Samples& beam = thermal.temperature[kBeam];
  const Samples& board = thermal.temperature[kBoard];
  const auto [coldest, hottest] = std::minmax_element(beam.begin(), beam.end());
  double fastest = 0;
  for (const double r : rate) fastest = std::max(fastest, std::abs(r));
  const StaticMap map(gyro, *coldest, *hottest, fastest);

  Signals signals(rate.size());
  for (std::size_t k = 0; k < rate.size(); ++k) {
    const StaticMap::Signals s = map.at(beam[k], rate[k]);
    const Electronics electronics = electronics_at(gyro, board[k]);
    const Output shown = electronics.output(s.at_rate.demodulated);
    signals.output[k] = shown.rate;
    signals.quadrature[k] = shown.quadrature;
    signals.bias[k] =
        rate[k] == 0 ? shown.rate : electronics.output(s.at_rest).rate;
    signals.drive_frequency[k] =
        s.at_rate.drive_frequency / (2 * std::numbers::pi);
    signals.drive_voltage[k] = s.at_rate.drive_voltage;
    signals.locked[k] = s.at_rate.amplitude_locked;
  }
  return signals;
}

void add_noise(const Scenario& scenario, const Device& device,
               const RunKey& key, const std::vector<int>& cycle,
               Samples& output) {
  RateNoise(device.noise, scenario.output_rate, scenario.seed, key.device,
            key.run)
      .add_next(output);
  const Samples turn_on = turn_on_offsets(device.noise, scenario.powered.size(),
                                          scenario.seed, key.device, key.run);
  for (std::size_t k = 0; k < output.size(); ++k) {
    if (cycle[k] >= 0) output[k] += turn_on[static_cast<std::size_t>(cycle[k])];
  }
}

Samples scaled(const Samples& values, double factor, double offset = 0) {
  Samples result(values.size());
  std::transform(values.begin(), values.end(), result.begin(),
                 [=](double v) { return v * factor + offset; });
  return result;
}

Samples quantised(const Samples& values, double factor, double resolution) {
  Samples result(values.size());
  std::transform(values.begin(), values.end(), result.begin(),
                 [=](double v) { return quantise(v * factor, resolution); });
  return result;
}

// Appends a measured column with the unpowered samples blanked.
void add_measured(Recording& recording, const char* name, const char* units,
                  const char* long_name, Samples values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (recording.status[k] & kUnpowered) values[k] = kNaN;
  }
  recording.columns.push_back(
      {name, units, long_name, Role::kMeasured, std::move(values)});
}

void add_measured_signals(Recording& recording, const Signals& signals,
                          const ReadoutParameters& readout,
                          Samples temperature) {
  const Readout chain(readout.full_scale, readout.adc_bits,
                      readout.scale_factor, readout.offset);
  Samples output(recording.time.size()), rate(recording.time.size());
  for (std::size_t k = 0; k < output.size(); ++k) {
    const ReadoutSample sample = chain.sample(signals.output[k]);
    output[k] = sample.voltage;
    rate[k] =
        (sample.voltage - readout.offset) / (readout.scale_factor * kDegree);
    if (recording.status[k] & kUnpowered) continue;
    if (sample.saturated) recording.status[k] |= kOutputSaturated;
    if (!signals.locked[k]) recording.status[k] |= kLoopNotLocked;
  }
  add_measured(recording, "output", "V", "voltage at the gyro's pin",
               std::move(output));
  add_measured(recording, "rate", "degree/s", "uncompensated rate",
               std::move(rate));
  add_measured(recording, "temperature", "degC", "temperature sensor",
               std::move(temperature));
  add_measured(recording, "drive_frequency", "Hz", "drive loop frequency",
               quantised(signals.drive_frequency, 1,
                         readout.drive_frequency_resolution));
  add_measured(
      recording, "drive_voltage", "V", "drive voltage amplitude",
      quantised(signals.drive_voltage, 1, readout.drive_voltage_resolution));
  add_measured(recording, "quadrature", "degree/s",
               "quadrature channel, rate-equivalent",
               quantised(signals.quadrature, 1 / kDegree,
                         readout.quadrature_resolution / kDegree));
}

void add_truth(Recording& recording, const Samples& rate,
               const Signals& signals, const ThermalHistory& thermal,
               const PiecewiseLinear& ambient) {
  const auto add = [&](std::string name, const char* units,
                       std::string long_name, Samples values) {
    recording.columns.push_back({std::move(name), units, std::move(long_name),
                                 Role::kTruth, std::move(values)});
  };
  add("true_rate", "degree/s", "rate about the input axis",
      scaled(rate, 1 / kDegree));
  add("true_bias", "degree/s", "zero-rate output of the noise-free twin",
      scaled(signals.bias, 1 / kDegree));
  for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
    add(fmt::format("true_{}_temperature", kThermalNodeNames[node]), "degC",
        fmt::format("temperature of the {}", kThermalNodeNames[node]),
        scaled(thermal.temperature[node], 1, -kZeroCelsius));
  }
  add("true_ambient_temperature", "degC", "temperature of air and fixture",
      scaled(ambient.sample(recording.time), 1, -kZeroCelsius));
}

}  // namespace

Recording simulate_quasistatic(const Scenario& scenario, const Device& device,
                               const RunKey& key) {
  const Gyro gyro = make_gyro(device);
  Recording recording;
  recording.fidelity = "quasistatic";
  recording.seed = scenario.seed;
  recording.time = sample_times(scenario);

  const ThermalHistory thermal = temperatures(scenario, gyro, recording.time);
  const SampledRate rate =
      sampled_rate(scenario.rate, OutputFilter(device.readout.corner_frequency),
                   recording.time, scenario.output_rate, scenario.duration,
                   scenario.seed, key.device, key.run);
  Signals signals = deterministic_signals(gyro, thermal, rate.filtered);

  const std::vector<int> cycle = power_cycles(scenario, recording.time);
  if (scenario.noise_enabled)
    add_noise(scenario, device, key, cycle, signals.output);
  recording.status.assign(cycle.size(), 0);
  for (std::size_t k = 0; k < cycle.size(); ++k) {
    if (cycle[k] < 0) recording.status[k] = kUnpowered;
  }

  add_measured_signals(
      recording, signals, device.readout,
      temperature_readings(device.temperature_sensor, scenario.noise_enabled,
                           thermal.temperature[kSensor], scenario.seed,
                           key.device, key.run));
  add_truth(recording, rate.rate, signals, thermal, scenario.ambient);
  return recording;
}

}  // namespace beamgyro
