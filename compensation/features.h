// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "compensation/input.h"
#include "dataset/recording.h"

namespace beamgyro {

/// Temperatures [degC] a compensator accepts; others are clamped to it.
struct TemperatureRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();

  bool operator==(const TemperatureRange&) const = default;
};

/// Causal low-pass tau y' = x - y with y = x at the first sample, exact when
/// x runs straight between samples however irregular. It steps the lag
/// L = x - y:   L <- e^-h L + (x - x_before) (1 - e^-h) / h,   h = dt / tau.
class LowPass {
 public:
  explicit LowPass(double time_constant) : time_constant_(time_constant) {}

  /// Output at `time` [s], later than the time before; x in any unit.
  double step(double time, double x);
  void reset() { started_ = false; }

 private:
  double time_constant_;  // [s]
  bool started_ = false;
  double time_ = 0.0;  // [s]
  double x_ = 0.0;
  double lag_ = 0.0;
};

/// The inputs of a compensator sample by sample, the same in training and at
/// run time, as firmware would compute them. Filters and the time since
/// power-on start at the first powered sample after each unpowered one: a
/// low-pass at the temperature there, its rate of change (x - y) / tau at 0.
class FeatureStream {
 public:
  explicit FeatureStream(std::vector<Input> inputs,
                         const TemperatureRange& range = {});

  /// Takes the sample at `time` [s]: `measured[i]` is the value of the column
  /// of input i (ignored for since_power_on). Fills `features[i]` and returns
  /// true, or returns false for an unpowered sample. Temperatures are clamped
  /// before they are filtered. Throws std::invalid_argument naming an input
  /// that is not finite at a powered sample.
  bool step(double time, std::uint8_t status, std::span<const double> measured,
            std::span<double> features);

 private:
  std::vector<Input> inputs_;
  TemperatureRange range_;
  std::vector<LowPass> low_passes_;  // one per input, idle for other kinds
  bool powered_ = false;
  double power_on_time_ = 0.0;  // [s]
};

/// Inputs of every sample of a recording: one row per sample, one column per
/// input, NaN where unpowered. Throws std::invalid_argument naming an input
/// whose column the recording lacks, or as FeatureStream::step().
Eigen::ArrayXXd features_of(const std::vector<Input>& inputs,
                            const Recording& recording,
                            const TemperatureRange& range = {});

}  // namespace beamgyro
