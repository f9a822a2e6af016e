// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compensation/bias_model.h"
#include "compensation/cross_validation.h"
#include "compensation/training_rows.h"

namespace beamgyro {

constexpr double kLeastSpan = 10.0;  // [K]
constexpr double kWidestGap = 10.5;  // [K], between neighbouring temperatures
constexpr double kHysteresisBin = 5.0;  // [K]
constexpr double kSignificance = 4.0;   // [-], standard errors

/// A fit and what it was fitted to, for cautions().
struct FittedCase {
  const std::vector<Input>& inputs;
  const BiasModel& model;
  const BiasModel& baseline;
  const TrainingRows& rows;
  const TrainingRows& held_out;   // may be empty
  double temperature_resolution;  // [K], the coarsest of the recordings
  bool knows_between = false;     // the model knows what lies between the rows
};

/// What the data do not support, one line each: a temperature span under
/// kLeastSpan; gaps in coverage; a temperature too coarse for the slope of the
/// bias; held-out temperatures outside the training's; hysteresis() above the
/// rms residual and above kSignificance standard errors, of a model without an
/// input that tells rising from falling; an input that feels the rate in a
/// training at rest.
std::vector<std::string> cautions(const FittedCase& fitted);

/// Whether cautions() warned of an input that feels the rate and a training at
/// rest.
bool warned_of_rate(const std::vector<std::string>& warnings);

/// Smallest difference of two measured temperatures [K], 0 when all are equal.
double temperature_resolution(const Recording& recording);

struct Hysteresis {
  double difference;      // [deg/s], largest of the bins
  double standard_error;  // [deg/s], of it
};

/// What a model leaves that differs between legs of rising and of falling
/// temperature: the largest difference of the means of `residual` (one per row
/// [deg/s]) in bins of kHysteresisBin. The standard error takes the scatter
/// within a bin and direction, pooled. Nothing without a bin that has both.
std::optional<Hysteresis> hysteresis(const TrainingRows& rows,
                                     const Eigen::ArrayXd& residual);

/// Why the model must not claim to be better than a constant bias: nothing was
/// unseen; fewer than kLeastGroups were; its rms on unseen groups is not below
/// the constant's by kUsefulGain; its mean square is not below by more than the
/// standard error of the difference; or the groups disagree, so that its
/// `weight` beside a constant is below 1. Empty when it may.
std::string objection_to_claim(const std::optional<GroupErrors>& model,
                               const std::optional<GroupErrors>& constant,
                               double weight = 1.0);

}  // namespace beamgyro
