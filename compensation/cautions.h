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

/// A fit and what it was fitted to, for cautions().
struct FittedCase {
  const std::vector<Input>& inputs;
  const BiasModel& model;
  const BiasModel& baseline;
  const TrainingRows& rows;
  const TrainingRows& held_out;   // may be empty
  double temperature_resolution;  // [K], the coarsest of the recordings
};

/// What the data do not support, one line each: a temperature span under
/// kLeastSpan; gaps in coverage; a temperature too coarse for the slope of the
/// bias; held-out temperatures outside the training's; a bias that differs
/// between rising and falling temperature by more than the residual of a fit
/// that cannot tell them apart; an input that feels the rate in a training at
/// rest.
std::vector<std::string> cautions(const FittedCase& fitted);

/// Smallest difference of two measured temperatures [K], 0 when all are equal.
double temperature_resolution(const Recording& recording);

/// Largest difference of the mean bias between rising and falling legs at one
/// temperature [deg/s], in bins of 5 K; nothing without such a bin.
std::optional<double> hysteresis(const TrainingRows& rows);

/// Why the model must not claim to be better than a constant bias: nothing was
/// unseen, or its mean square residual on unseen groups is not below the
/// constant's by more than the standard error of the difference. Empty when it
/// may.
std::string objection_to_claim(const std::optional<GroupErrors>& model,
                               const std::optional<GroupErrors>& constant);

}  // namespace beamgyro
