// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/rows/row_groups.h"
#include "compensation/uncertainty/sigma_calibration.h"

namespace beamgyro::internal {

/// Mean square residual [(deg/s)^2] of each group.
using GroupErrors = Eigen::ArrayXd;

double rms_of(const GroupErrors& errors);  // root of their mean [deg/s]
/// Returns the standard error of the mean [(deg/s)^2], infinite with fewer than
/// two groups.
double standard_error(const GroupErrors& errors);

/// Predicted bias [deg/s] of each row, by a model that has not seen the row.
struct Predictions {
  Eigen::ArrayXd bias;
  RowMask scored;  // rows that count
};

Predictions predict_all(const BiasModel& model, const TrainingRows& rows);

/// Returns the rows of a group whose temperatures lie between those of the
/// other groups.
RowMask between_others(const TrainingRows& rows, const RowGroups& groups,
                       int group);

/// Returns the mean square of `bias` less the prediction, over the scored rows
/// of each group.
GroupErrors group_errors(const Predictions& predictions,
                         const Eigen::ArrayXd& bias, const RowGroups& groups);

/// Largest number of restarts of a network in a fold; the model that is kept
/// may have more.
constexpr int kFoldRestarts = 2;

/// Predicts each group by a fit to all others, with temperatures clamped to
/// those of the others.
/// - Rows beyond the temperatures of the others are not scored if the group has
///   any rows within them, because the fit to all groups has no need to
///   extrapolate either.
/// - A network starts from kFoldRestarts sets of weights at most and runs to
///   its end. Stopping early on one of the groups would stop it by the slow
///   noise of that group.
/// - Folds run on `threads` threads, 0 for one per core. Results do not depend
///   on it.
/// Throws std::invalid_argument for fewer than two groups and as fit_model(),
/// with the first group that cannot be held out.
Predictions predict_unseen(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads = 0);

/// Returns the predicted bias [deg/s] of `asked`, rows of which each belongs to
/// one of the groups, by the fits of predict_unseen() to all other groups. They
/// may be of ramps and warm-ups that `rows` leaves out.
Eigen::ArrayXd predict_others(const FitSpec& kind,
                              const std::vector<Input>& inputs,
                              const TrainingRows& rows, const RowGroups& groups,
                              const TrainingRows& asked,
                              const Eigen::ArrayXi& group_of_asked,
                              std::uint64_t seed, int threads = 0);

/// Returns the predictions (1 - weight) constant + weight model of the same
/// rows.
Predictions averaged(const Predictions& constant, const Predictions& model,
                     double weight);

struct StackingWeight {
  double value;           // [-], 0 to 1
  double standard_error;  // [-], from the groups' scatter
  // [-], 0 to 1: the share of what the model leaves that a scale of its own in
  // each group would take away. Near 1 where groups have one shape of different
  // size, small where they have different shapes or other offsets.
  double share_of_scale;
};

/// Returns the weight of `model` in averaged(), from 0 to 1, that gives the
/// least mean of the groups' mean square residuals. It is near 1 where every
/// group supports the model, smaller where groups disagree, and 0 where they
/// contradict it.
StackingWeight stacking_weight(const Predictions& constant,
                               const Predictions& model,
                               const Eigen::ArrayXd& bias,
                               const RowGroups& groups);

/// From this weight on a model counts as whole.
constexpr double kWholeWeight = 0.9;  // [-]

/// Smallest StackingWeight::share_of_scale for which a model is averaged.
constexpr double kLeastShareOfScale = 0.5;  // [-]

/// Fewer groups than this are no evidence.
constexpr int kLeastGroups = 3;

/// Smallest share of the rms of a constant that a model must take away.
constexpr double kUsefulGain = 0.1;  // [-]

/// Smallest shares of the rms of the cubic that others must take away: of a
/// candidate that is richer, and of a constant where there are fewer than
/// kLeastGroups groups. Of others it is kUsefulGain.
constexpr double kRicherGain = 0.05;   // [-]
constexpr double kConstantGain = 0.2;  // [-]

/// Largest relative excess of rms that a simpler model may have.
constexpr double kAllowedExcess = 0.02;  // [-]

/// Returns whether a model leaves less than another one by `least`, a share of
/// its rms, and by more than the standard error of the difference over groups:
/// of two groups, less in both.
bool is_clearly_less(const GroupErrors& model, const GroupErrors& other,
                     double least);

/// Returns the index of the first model whose rms residual exceeds the least
/// one by no more than kAllowedExcess. Models are in order, simplest first;
/// of each the residuals on unseen groups.
std::size_t choose(const std::vector<GroupErrors>& models);

}  // namespace beamgyro::internal
