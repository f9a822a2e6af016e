// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/models/lookup_table.h"
#include "compensation/network/network_training.h"
#include "compensation/rows/row_groups.h"
#include "compensation/rows/run_source.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/model_file.h"

namespace beamgyro::internal {

/// Fits the scale factor of the gyro over temperature, relative to the nominal
/// one [-]: the slope of rate over true_rate on every plateau at which the true
/// rate varies by kTableRate or more, pooled in bins of `bin_width` [K]. The
/// runs are visited once. Throws std::invalid_argument when there is no such
/// plateau.
LookupTable fit_scale_factor(const RunSource& runs, double bin_width);

struct TrainResult {
  FittedCompensator compensator;
  std::vector<TrainSummary> restarts;  // one unless it is a network; [deg/s]
  std::size_t chosen = 0;              // the restart kept
  Eigen::Index rows = 0;
  Eigen::Index held_out_rows = 0;
  std::vector<std::string> sigma_remarks;  // why there is no sigma, and so on

  const TrainSummary& summary() const { return restarts[chosen]; }
};

/// Fits `spec` and the baseline, the cubic of equation (1), to the rows of
/// `runs` (training_rows()), and their sigma (fit_bias_sigma()). The runs are
/// visited once, and once more each for a scale-factor table and for sigma.
/// - A network stops early on the rows of `held_out`; best_network() chooses
///   among its restarts and weight decays.
/// - With `cross_validation` every group of that kind is predicted by a fit to
///   the others (cross_validate()). A network without held-out runs then takes
///   its weight decay from there and runs all its epochs.
/// - Of several candidates select_model() chooses one, or its average with a
///   constant. It judges by cross-validation, or else by the groups of the
///   held-out runs, or else by folds_of() the rows.
///
/// Throws as training_rows(), and std::invalid_argument when
/// - there is no run, or one that is another or a part of it
///   (require_different_runs());
/// - a network has neither held-out runs nor cross-validation;
/// - the temperatures are too few or too close together, or an input never
///   varies.
TrainResult train(const ModelSpec& spec, const RunSource& runs,
                  const RunSource& held_out, std::uint64_t seed,
                  std::optional<Grouping> cross_validation = {});
TrainResult train(const ModelSpec& spec, const std::vector<TrainingRun>& runs,
                  const std::vector<TrainingRun>& held_out, std::uint64_t seed,
                  std::optional<Grouping> cross_validation = {});

}  // namespace beamgyro::internal
