// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/measured_sketch.h"
#include "compensation/inputs/features.h"
#include "compensation/inputs/input.h"
#include "compensation/methods/bias_model.h"
#include "compensation/methods/population.h"
#include "compensation/rows/run_source.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A file that a compensator was trained on, or that was held out.
struct SourceFile {
  std::string name;
  std::string sha256;  // 64 hexadecimal digits
  // measured_sha256() of the recording; empty in files of older programs.
  std::string measured_sha256 = {};
  MeasuredSketch sketch = {};  // measured_sketch(); empty in these, too
  std::optional<std::uint64_t> seed = {};  // noise_seed()

  bool operator==(const SourceFile&) const = default;
};

/// Cross-validation: residuals on each group of rows of a model fitted to all
/// other groups.
struct CrossValidated {
  std::string by;  // "run", "cycle", "leg" or "segment"
  std::size_t groups = 0;
  double rms = 0.0;             // [deg/s], root of the mean of the groups'
  double standard_error = 0.0;  // [deg/s], of it
  double constant_rms = 0.0;    // [deg/s], of a constant bias
  // [deg/s], of each group in turn; empty in files of older programs
  std::vector<double> group_rms, constant_group_rms;

  bool operator==(const CrossValidated&) const = default;
};

/// Origin of a compensator: data, model file and scores of training.
struct Provenance {
  std::string method;  // "cubic as PX4 fits it", ...
  std::vector<SourceFile> training;
  std::vector<SourceFile> held_out;
  // In place of files: the set that the runs come from.
  std::optional<TrainingSet> training_set, held_out_set;
  // SHA-256 of stated_device() of the one simulated device that the training
  // files are of. Empty of logs, of several devices and of sets.
  std::string device_sha256 = {};
  std::string model_text;  // model file byte for byte as read
  std::uint64_t seed = 0;
  std::string stop_reason;
  std::vector<std::string> choices;   // what was chosen, from what, and why
  std::vector<std::string> warnings;  // what the data do not support
  std::optional<CrossValidated> cross_validated;
  double in_sample_rms = 0.0;           // [deg/s], over the training rows
  std::optional<double> held_out_rms;   // [deg/s], over the held-out rows
  double baseline_in_sample_rms = 0.0;  // [deg/s]
  std::optional<double> baseline_held_out_rms;  // [deg/s]
  // [deg/s], of the straight lines; nothing without them
  std::optional<double> lines_in_sample_rms, lines_held_out_rms;
  std::optional<double> constant_bias;  // [deg/s], mean of the training rows
  double constant_in_sample_rms = 0.0;  // [deg/s], of that constant
  std::optional<double> constant_held_out_rms;  // [deg/s]

  bool operator==(const Provenance&) const = default;
};

/// A trained compensator: compensated rate = (rate - bias(inputs)) / s(T).
/// Works in the units of the recording: temperatures in degC, rates in deg/s.
struct FittedCompensator {
  std::vector<Input> inputs;
  BiasModel bias;                           // of `inputs`
  std::optional<LookupTable> scale_factor;  // s(T) [-]; 1 without
  BiasModel baseline;  // of the temperature: the cubic of equation (1)
  // Beside it, of the same rows: fit_straight_lines(). Files of older programs
  // have none.
  std::optional<LookupTable> straight_lines = {};
  TemperatureRange temperature_range;  // [degC], seen in training
  // The population that was learned, from which devices are adapted. The bias
  // is its mean then.
  std::optional<Population> population = {};
  Provenance provenance;
  // 1-sigma of the bias that is left; nothing where training could not tell it.
  std::optional<BiasSigma> sigma = {};
  // Why not, in words; empty with a sigma, of a method that never has one, and
  // in files of older programs.
  std::string sigma_not_known = {};
};

/// Returns the compensated rate [deg/s] of every sample, NaN where unpowered.
/// Throws std::invalid_argument naming an input that the recording lacks, or
/// the time of a powered sample whose input is not finite.
std::vector<double> compensated_rate(const FittedCompensator& compensator,
                                     const Recording& recording);

/// Returns the 1-sigma [deg/s] of the bias of every compensated rate, NaN where
/// unpowered: sigma / s(T). Empty for a compensator without one. Throws
/// std::invalid_argument as compensated_rate().
std::vector<double> compensated_rate_sigma(const FittedCompensator& compensator,
                                           const Recording& recording);

/// Returns the compensated rate of the baseline of the compensator, the cubic
/// of equation (1), with s = 1.
std::vector<double> baseline_rate(const FittedCompensator& compensator,
                                  const Recording& recording);

/// Returns that of its straight lines. The compensator must have them.
std::vector<double> straight_lines_rate(const FittedCompensator& compensator,
                                        const Recording& recording);

/// Returns the number of powered samples whose measured temperature was clamped
/// because it lies outside the range of the compensator.
std::size_t clamped_samples(const FittedCompensator& compensator,
                            const Recording& recording);

/// Returns what beamgyro::Compensator::curve() says.
std::string settled_curve(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
