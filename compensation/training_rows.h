// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compensation/features.h"
#include "compensation/input.h"
#include "compensation/model_file.h"
#include "dataset/recording.h"

namespace beamgyro {

/// A recording given for training or held out from it.
struct TrainingRun {
  std::string name;    // file name, for messages and the provenance
  std::string sha256;  // of the file
  Recording recording;
};

/// Means over blocks of samples: what a model is fitted to.
struct TrainingRows {
  Eigen::ArrayXXd inputs;      // one row per block, one column per input
  Eigen::ArrayXd temperature;  // [degC], measured
  Eigen::ArrayXd bias;         // [deg/s], measured rate - known true rate
  TemperatureRange range;      // [degC], of the samples that were averaged

  Eigen::Index size() const { return bias.size(); }
};

/// Rows of all runs. Inputs are computed at the rate of the recording and then
/// averaged over consecutive blocks of `options.seconds`, counted from each
/// power-on, together with the label rate - true_rate. Samples without power,
/// saturated or with a loop not locked are left out; so are blocks with less
/// than half the samples of the fullest block of their run, and, with
/// steady_K_per_min, blocks over which the slope of a straight line through
/// the measured temperature is steeper. Temperatures are clamped to `range` as
/// at run time. Throws std::invalid_argument naming the run and an input it
/// lacks, a true_rate it lacks, a sample that is not finite, or that it has no
/// usable sample; and when no row is left.
TrainingRows training_rows(const std::vector<TrainingRun>& runs,
                           const std::vector<Input>& inputs,
                           const RowOptions& options,
                           const TemperatureRange& range = {});

}  // namespace beamgyro
