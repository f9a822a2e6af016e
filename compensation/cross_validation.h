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

/// Mean square residual of each group of `rows`.
GroupErrors group_errors(const BiasModel& model, const TrainingRows& rows,
                         const RowGroups& groups);

/// Restarts of a network in a fold: more would be tried for the one kept.
constexpr int kFoldRestarts = 2;

/// Mean square residual of each group, predicted by a fit to all others with
/// temperatures clamped to theirs. Rows beyond the temperatures of the others
/// are not scored, if the group has any between: the fit to all groups is not
/// asked to go beyond them either. A network starts from kFoldRestarts sets of
/// weights at most and runs to its end: to stop early on one of the groups
/// would stop it by that group's slow noise. Folds run on `threads` threads, 0
/// for as many as there are cores, on which no result depends. Throws
/// std::invalid_argument for fewer than two groups and as fit_model(), with the
/// first group that cannot be held out.
GroupErrors cross_validate(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads = 0);

/// One model among several and its residuals on unseen groups.
struct Scored {
  std::string name;
  GroupErrors errors;
};

/// The largest excess of rms a simpler model may have.
constexpr double kAllowedExcess = 0.02;  // [-]

/// The one-standard-error rule: the first model (they come simplest first)
/// whose mean square residual exceeds the least one by no more than the
/// standard error of their difference over the groups, nor its root by
/// kAllowedExcess: with few groups the standard error alone excuses anything.
std::size_t choose(const std::vector<Scored>& models);

}  // namespace beamgyro
