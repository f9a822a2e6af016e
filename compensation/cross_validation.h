// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "compensation/fit.h"
#include "compensation/row_groups.h"

namespace beamgyro {

/// Mean square residual [(deg/s)^2] of each group.
using GroupErrors = Eigen::ArrayXd;

double rms_of(const GroupErrors& errors);  // root of their mean [deg/s]
/// Standard error of the mean [(deg/s)^2]; infinite with fewer than two.
double standard_error(const GroupErrors& errors);

/// Bias [deg/s] of each row as a model predicts it that has not seen the row.
struct Predictions {
  Eigen::ArrayXd bias;
  Eigen::Array<bool, Eigen::Dynamic, 1> scored;  // rows that count
};

Predictions predict_all(const BiasModel& model, const TrainingRows& rows);

/// Mean square of `bias` less what is predicted, over the rows of each group
/// that are scored.
GroupErrors group_errors(const Predictions& predictions,
                         const Eigen::ArrayXd& bias, const RowGroups& groups);

/// Restarts of a network in a fold: more would be tried for the one kept.
constexpr int kFoldRestarts = 2;

/// Predicts each group by a fit to all others, with temperatures clamped to
/// theirs. Rows beyond the temperatures of the others are not scored, if the
/// group has any between: the fit to all groups is not asked to go beyond them
/// either. A network starts from kFoldRestarts sets of weights at most and runs
/// to its end: to stop early on one of the groups would stop it by that group's
/// slow noise. Folds run on `threads` threads, 0 for as many as there are
/// cores, on which no result depends. Throws std::invalid_argument for fewer
/// than two groups and as fit_model(), with the first group that cannot be held
/// out.
Predictions predict_unseen(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads = 0);

/// group_errors() of predict_unseen().
GroupErrors cross_validate(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads = 0);

/// The predictions (1 - weight) constant + weight model, of the same rows.
Predictions averaged(const Predictions& constant, const Predictions& model,
                     double weight);

struct StackingWeight {
  double value;           // [-], 0 to 1
  double standard_error;  // [-], from the groups' scatter
};

/// The weight of `model` in averaged(), from 0 to 1, with the least mean of the
/// groups' mean square residuals: near 1 where every group bears the model out,
/// less where groups disagree, 0 where they contradict it.
StackingWeight stacking_weight(const Predictions& constant,
                               const Predictions& model,
                               const Eigen::ArrayXd& bias,
                               const RowGroups& groups);

/// One model among several and its residuals on unseen groups.
struct Scored {
  std::string name;
  GroupErrors errors;
};

/// Fewer groups are no evidence.
constexpr int kLeastGroups = 3;

/// The least part of a constant's rms that a model must take away.
constexpr double kUsefulGain = 0.1;  // [-]

/// The largest excess of rms that simplicity excuses.
constexpr double kAllowedExcess = 0.02;  // [-]

/// The first model (they come simplest first) whose root mean square residual
/// exceeds the least one by no more than kAllowedExcess.
std::size_t choose(const std::vector<Scored>& models);

}  // namespace beamgyro
