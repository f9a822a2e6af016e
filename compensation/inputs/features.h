// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "compensation/inputs/input.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Range of temperatures [degC] of a compensator. Others are clamped to it.
struct TemperatureRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();

  bool operator==(const TemperatureRange&) const = default;
};

/// Causal low-pass tau y' = x - y with y = x at the first sample. It is exact
/// for an x with straight lines between samples at any intervals. It advances
/// the lag L = x - y: L <- e^-h L + (x - x_before) (1 - e^-h) / h, h = dt /
/// tau.
class LowPass {
 public:
  explicit LowPass(double time_constant) : time_constant_(time_constant) {}

  /// Returns the output at `time` [s], which must be later than the time
  /// before. x has any unit.
  double step(double time, double x);
  void reset() { started_ = false; }

 private:
  double time_constant_;  // [s]
  bool started_ = false;
  double time_ = 0.0;  // [s]
  double x_ = 0.0;
  double lag_ = 0.0;
};

/// Play operator p <- min(max(p, x - r), x + r) with p = x at the first sample:
/// it follows x only when pushed, so it knows from which side x has come.
class Play {
 public:
  explicit Play(double half_width) : half_width_(half_width) {}

  /// Returns p. x has the unit of the half-width.
  double step(double x);
  void reset() { started_ = false; }

 private:
  double half_width_;
  bool started_ = false;
  double p_ = 0.0;
};

/// Computes the inputs of a compensator sample by sample, as firmware would, in
/// training and at run time alike. Filters and the time since power-on start at
/// the first powered sample after an unpowered one: a low-pass and a play start
/// at the value there, the rate of change (x - y) / tau at 0.
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
  std::vector<Play> plays_;          // likewise
  bool powered_ = false;
  double power_on_time_ = 0.0;  // [s]
};

/// Returns the inputs of every sample of a recording, one row for each sample
/// and one column for each input, NaN where unpowered. Throws
/// std::invalid_argument naming an input whose column the recording lacks, and
/// as FeatureStream::step().
Eigen::ArrayXXd features_of(const std::vector<Input>& inputs,
                            const Recording& recording,
                            const TemperatureRange& range = {});

}  // namespace beamgyro::internal
