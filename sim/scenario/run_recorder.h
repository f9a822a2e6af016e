// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "dataset/recording/recording.h"
#include "sim/device/device.h"
#include "sim/memory/memory_parameters.h"
#include "sim/scenario/scenario.h"
#include "sim/signal/noise.h"
#include "sim/signal/readout.h"
#include "sim/signal/temperature_sensor.h"

namespace beamgyro::internal {

/// Device and run number, which select the random streams of a run together
/// with the seed of its scenario.
struct RunKey {
  std::uint32_t device = 0;
  std::uint32_t run = 0;
};

/// Receives a run block by block: recordings with the same columns whose
/// samples follow each other. The receiver adds texts and versions.
using BlockSink = std::function<void(Recording&& block)>;

inline constexpr std::size_t kBlockSamples = 16384;

/// Consecutive samples of a run in SI units, before noise and readout.
struct RunSamples {
  std::vector<double> time;                // [s]
  std::vector<double> output, quadrature;  // rate-equivalent [rad/s]
  std::vector<double> bias;                // output of the twin [rad/s]
  // Its part by spurious modes [rad/s]; empty for a unit without.
  std::vector<double> spurious_bias;
  std::vector<double> drive_frequency;  // [Hz]
  std::vector<double> drive_voltage;    // [V]
  // Noise of these two channels; empty without.
  std::vector<double> drive_frequency_noise;  // [Hz]
  std::vector<double> drive_voltage_noise;    // [V]
  std::vector<std::uint8_t> locked;
  std::array<std::vector<double>, kThermalNodeCount> temperature;  // [K]
  std::vector<MemoryState> memory;  // empty without memory effects

  // The motion of the case [rad/s] [m/s2]: the rate about the input axis, and
  // the other axes that the scenario moves. Axes that do not move are empty.
  PerAxis<std::vector<double>> motion;
};

/// Noise that the loops of a run bring to its samples.
struct RunNoise {
  /// White noise in front of the output stage [rad/sqrt(s)], for runs that do
  /// not simulate it.
  double sensing = 0;
  /// Rms of drive frequency [Hz] and voltage [V] in the channels; 0: none.
  double drive_frequency = 0, drive_voltage = 0;
};

/// Makes recordings from the samples of one run:
/// - adds noise, turn-on offset and turn-on transient to the output;
/// - adds the errors of the channels of the loops (loop_channels.h);
/// - applies saturation, ADC, resolutions and the temperature sensor;
/// - sets measured values without power to NaN, and sets `status`.
/// The recording does not depend on how the run is cut into blocks.
class RunRecorder {
 public:
  /// `device` and `scenario` must outlive the recorder.
  RunRecorder(const ScenarioPlan& scenario, const DeviceParameters& device,
              const RunKey& key, const RunNoise& loop_noise = {});

  /// Returns the recording of the next samples, with every column
  /// (docs/reference/recording.md).
  Recording block(RunSamples&& samples);

 private:
  using Samples = std::vector<double>;

  // Range of the powered samples of a block: from `first` to before `last`.
  struct PoweredSamples {
    std::size_t first, last;
    std::size_t cycle;
  };
  std::vector<PoweredSamples> powered(const Samples& times) const;

  void add_output_noise(const Samples& times, Samples& output);
  void add_measured(Recording& block, RunSamples& samples);
  void add_loop_channels(Recording& block, const RunSamples& samples);
  void add_truth(Recording& block, RunSamples& samples) const;
  void add_memory(Recording& block, const RunSamples& samples) const;

  const ScenarioPlan& scenario_;
  const DeviceParameters& device_;
  RateNoise noise_;
  std::vector<double> turn_on_;     // of each power cycle [rad/s]
  std::vector<double> transients_;  // of each power cycle, at power-on [rad/s]
  double quadrature_sigma_;         // white noise of a sample [rad/s]
  RandomStream quadrature_stream_;
  RunNoise loop_noise_;
  TemperatureSensor sensor_;
  Readout readout_;
};

}  // namespace beamgyro::internal
