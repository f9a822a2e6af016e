// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/cross_validation.h"
#include "compensation/training/model_file.h"

namespace beamgyro::internal {

/// Whether it is "none" or "constant".
bool is_constant(const FitSpec& kind);

/// Returns whether the bias moves more than slow noise would: its variance is
/// above n s^2 / 20, with n rows and s^2 half the mean square second difference
/// within a cycle. White noise alone gives s^2 / 3, a random walk alone n s^2 /
/// 6. This serves for a single leg of temperature. There the temperature is a
/// function of time, like a random walk, and no group can be held out to
/// distinguish them.
bool moves_more_than_noise(const TrainingRows& rows);

/// The data that models are fitted to and judged on.
struct SelectionData {
  const std::vector<Input>& inputs;  // of the columns of the rows
  const TrainingRows& rows;
  const TrainingRows& held_out;     // may be empty
  std::optional<RowGroups> groups;  // cross-validation over `rows`
  std::uint64_t seed;
};

/// A model and the reasons for its choice.
struct Selected {
  Candidate candidate;
  double weight = 1.0;  // > 0, of the candidate; the rest is a constant's
  Fit fit;              // to all rows; its choices tell of every candidate
  // Residuals of the model and of a constant on unseen groups.
  std::optional<GroupErrors> errors, constant_errors;
};

/// Fits the candidate that choose() takes, or the only one. Without groups
/// several candidates are judged by the held-out rows. Of several,
/// - each is averaged with a constant by stacking_weight(), where that lowers
///   its rms on unseen groups by more than kAllowedExcess; with fewer than
///   kLeastGroups the weight is a quarter of its standard error lower;
/// - the one chosen gives way to "none" or "constant", if they are candidates,
///   unless it takes away kUsefulGain of their rms.
///
/// Passed over, and said so, is a candidate that the rows do not determine, and
/// of several that are cross-validated
/// - by segments (one leg): all but curves up to the cubic, and all but
///   constants unless the bias moves_more_than_noise(). Of those the richest is
///   kept that leaves less than a constant, and not averaged: segments are no
///   independent groups;
/// - by fewer than kLeastGroups: networks;
/// - with since_power_on among the inputs: where power came on at fewer than
///   three temperatures 10 K apart, since warm-ups elsewhere would be a guess.
/// Throws std::invalid_argument when none is left, as fit_model() for the only
/// one.
Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data);

}  // namespace beamgyro::internal
