// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/rows/row_groups.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/model_file.h"

namespace beamgyro::internal {

/// Whether it is "none" or "constant".
bool is_constant(const FitSpec& kind);

/// Whether it is the cubic of the temperature alone, which the automatic choice
/// takes unless evidence speaks for another candidate.
bool is_cubic(const Candidate& candidate);

/// Returns whether the bias moves more than slow noise would: its variance is
/// above n s^2 / 20, with n rows and s^2 half the mean square second difference
/// within a cycle. White noise alone gives s^2 / 3, a random walk alone n s^2 /
/// 6. This serves for a single leg of temperature. There the temperature is a
/// function of time, like a random walk, and no group can be held out to
/// distinguish them.
bool moves_more_than_noise(const TrainingRows& rows);

/// Returns whether rows tell an input that comes from the temperature from the
/// temperature itself: in half or more of the tenths of the span of
/// temperatures, its difference from the temperature takes values at least half
/// as far apart as in all rows. Along legs of one direction and one rate it
/// does not. `difference` has one value per row.
bool is_told_apart(const Eigen::ArrayXd& temperature,
                   const Eigen::ArrayXd& difference);

struct RemovedInputs {
  std::vector<std::string> names;
  std::string reason;  // what the rows do not tell
};

/// Removes the inputs of a candidate, but the first, of which the rows give no
/// evidence. `inputs` are the columns of the rows. Removed are
/// - since_power_on, where power came on at fewer than three temperatures 10 K
///   apart: warm-ups elsewhere would be a guess;
/// - low-passes, rates and plays of the temperature that are not told apart
///   (is_told_apart()) in the rows without some group: such a group has a past
///   that the others do not know.
RemovedInputs remove_inputs_without_evidence(Candidate& candidate,
                                             const std::vector<Input>& inputs,
                                             const TrainingRows& rows,
                                             const RowGroups& groups);

/// Returns why unseen groups cannot judge a candidate of several, or an empty
/// text when they can. See select_model().
std::string objection_to_candidate(const Candidate& candidate,
                                   const TrainingRows& rows,
                                   const RowGroups& groups);

/// Throws std::invalid_argument for a network of several inputs and fewer than
/// kLeastGroups groups: two legs do not tell its inputs apart.
void require_groups_for_inputs(const Candidate& candidate,
                               const RowGroups& groups);

}  // namespace beamgyro::internal
