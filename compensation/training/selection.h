// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/candidate_evidence.h"
#include "compensation/training/cross_validation.h"
#include "compensation/training/model_file.h"

namespace beamgyro::internal {

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

/// Fits the candidate that unseen groups support, or the only one. Without
/// groups several candidates are judged by the held-out rows. Of several,
/// - each is averaged with a constant by stacking_weight() where groups
/// disagree
///   on its scale: the weight is below kWholeWeight, and share_of_scale is
///   kLeastShareOfScale or more. With fewer than kLeastGroups the weight is a
///   quarter of its standard error lower; a weight of 0 is a constant;
/// - the cubic of the temperature, if it is one of them and the bias
///   moves_more_than_noise(), is kept unless others leave clearly less
///   (is_clearly_less()): by kUsefulGain, those after it in the list by
///   kRicherGain, a constant by kConstantGain where there are fewer than
///   kLeastGroups. A table gives way to a spline unless it leaves less than
///   that by kUsefulGain. Of those others choose() takes one;
/// - else choose() takes one of all, which gives way to "none" or
///   "constant", if they are candidates, unless it takes away kUsefulGain of
///   their rms.
///
/// Of several that are cross-validated, inputs without evidence are removed
/// (remove_inputs_without_evidence()), and passed over is, and said so, what
/// the rows do not determine, a polynomial whose further inputs are all
/// removed, and
/// - by segments (one leg): all but curves up to the cubic, and all but
///   constants unless the bias moves_more_than_noise(). Of those the richest is
///   kept that leaves less than a constant, and not averaged: segments are no
///   independent groups;
/// - by fewer than kLeastGroups: networks.
/// A network alone, of several weight decays, takes the strongest decay within
/// kAllowedExcess of the best. Throws std::invalid_argument when no candidate
/// is left, as fit_model() for the only one, and as require_groups_for_inputs()
/// for it.
Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data);

}  // namespace beamgyro::internal
