// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "dataset/recording.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"
#include "sim/signal/noise.h"
#include "sim/signal/readout.h"
#include "sim/signal/temperature_sensor.h"

namespace beamgyro {

/// Which random streams a run draws from, beside the seed of its scenario.
struct RunKey {
  std::uint32_t device = 0;
  std::uint32_t run = 0;
};

/// Takes a run block by block: recordings with the same columns whose samples
/// follow each other. Texts and versions are the receiver's.
using BlockSink = std::function<void(Recording&& block)>;

inline constexpr std::size_t kBlockSamples = 16384;

/// Consecutive samples of a run, SI, before noise and readout.
struct RunSamples {
  std::vector<double> time;                // [s]
  std::vector<double> output, quadrature;  // rate-equivalent [rad/s]
  std::vector<double> bias;                // output of the twin [rad/s]
  std::vector<double> drive_frequency;     // [Hz]
  std::vector<double> drive_voltage;       // [V]
  std::vector<std::uint8_t> locked;
  std::array<std::vector<double>, kThermalNodeCount> temperature;  // [K]

  // The motion of the case: rate about the input axis, and the axes that the
  // scenario moves besides, else empty.
  std::vector<double> rate;                         // [rad/s]
  std::array<std::vector<double>, 2> cross_rate;    // [rad/s]
  std::array<std::vector<double>, 3> acceleration;  // [m/s2]
};

/// Makes recordings of the samples of one run: adds noise and turn-on offset to
/// the output, then saturation, ADC, resolutions and the temperature sensor,
/// blanks what is measured without power, sets `status`. The recording does not
/// depend on how the run is cut into blocks.
class RunRecorder {
 public:
  /// `device` and `scenario` must outlive the recorder. `sensing_noise` is
  /// white noise in front of the output stage [rad/sqrt(s)], where a run does
  /// not simulate it.
  RunRecorder(const Scenario& scenario, const Device& device, const RunKey& key,
              double sensing_noise = 0);

  /// The next samples, with every column (docs/reference/recording.md).
  Recording block(RunSamples&& samples);

 private:
  // Samples of a block with power, first to before last.
  struct PoweredSamples {
    std::size_t first, last;
    double turn_on;  // [rad/s]
  };
  std::vector<PoweredSamples> powered(const std::vector<double>& times) const;

  void add_measured(Recording& block, RunSamples& samples);
  void add_truth(Recording& block, RunSamples& samples) const;

  const Scenario& scenario_;
  const Device& device_;
  RateNoise noise_;
  std::vector<double> turn_on_;  // of each power cycle [rad/s]
  TemperatureSensor sensor_;
  Readout readout_;
};

}  // namespace beamgyro
