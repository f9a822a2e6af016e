// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/methods/bias_model.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/cross_validation.h"

namespace beamgyro::internal {

constexpr double kLeastSpan = 10.0;  // [K]
constexpr double kWidestGap = 10.5;  // [K], between neighbouring temperatures
constexpr double kHysteresisBin = 5.0;  // [K]
constexpr double kSignificance = 4.0;   // [-], standard errors

/// A fit and the data that it was fitted to, for cautions().
struct FittedCase {
  const std::vector<Input>& inputs;
  const BiasModel& model;
  const BiasModel& baseline;
  const TrainingRows& rows;
  const TrainingRows& held_out;   // may be empty
  double temperature_resolution;  // [K], the coarsest of the recordings
  bool knows_between = false;     // the model knows what lies between the rows
  bool is_ageing = false;         // a device of the recordings, by stated_age()
};

/// Returns one line for each claim that the data do not support:
/// - a temperature span under kLeastSpan;
/// - gaps in coverage;
/// - a temperature too coarse for the slope of the bias;
/// - held-out temperatures outside those of training;
/// - hysteresis() above the rms residual and above kSignificance standard
///   errors, for a model without an input that distinguishes rising from
///   falling temperature;
/// - an input that feels the rate, with training at rest;
/// - drive_frequency as an input, where is_ageing.
std::vector<std::string> cautions(const FittedCase& fitted);

/// Returns the smallest difference of two measured temperatures [K], or 0 when
/// all are equal.
double temperature_resolution(const Recording& recording);

struct Hysteresis {
  double difference;      // [deg/s], largest of the bins
  double standard_error;  // [deg/s], of it
};

/// Returns the hysteresis that a model leaves: the largest difference between
/// the means of `residual` (one per row [deg/s]) on legs of rising and of
/// falling temperature, in bins of kHysteresisBin. The standard error comes
/// from the pooled scatter within a bin and direction. Returns nothing when no
/// bin has both directions.
std::optional<Hysteresis> hysteresis(const TrainingRows& rows,
                                     const Eigen::ArrayXd& residual);

/// Returns why the model must not claim to be better than a constant bias, or
/// an empty text when it may. The reasons are:
/// - no group, or fewer than kLeastGroups, was unseen;
/// - its rms on unseen groups is not below that of the constant by kUsefulGain;
/// - its mean square is not below by more than the standard error of the
///   difference;
/// - the groups disagree, so that its `weight` in the average with a constant
///   is below 1.
std::string objection_to_claim(const std::optional<GroupErrors>& model,
                               const std::optional<GroupErrors>& constant,
                               double weight = 1.0);

/// Returns the share of a small rate that a compensator passes in the range of
/// its training: 1 less the mean slope of its bias over the rate, for rates
/// within 1 deg/s, over the range of its temperature and of its input `rate` or
/// `output`.
///
/// A compensator file does not have the scale factor of `output`. If training
/// was at rest, only the bias moved the output, and the scale factor follows
/// from the spans of the two. Returns nothing for an input `output` with
/// training on rates, where a model cannot mistake them for bias, and for
/// compensators that use neither input.
std::optional<double> rate_kept(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
