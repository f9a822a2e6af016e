// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Kind of group that is held out as a whole. Random samples are not among
/// them, because neighbours in time share the drift.
enum class Grouping {
  kRun,      // recordings
  kCycle,    // times from power-on to the loss of power
  kLeg,      // between reversals of the temperature
  kSegment,  // every fifth of twenty pieces, where there is nothing else
};

std::string grouping_name(Grouping by);  // "run", "cycle", "leg", "segment"

struct RowGroups {
  Grouping by = Grouping::kRun;
  Eigen::ArrayXi of_row;  // 0 ... count - 1
  int count = 0;
};

/// Divides the rows into groups of at least 2 rows. A smaller group joins the
/// one before it.
RowGroups group_rows(const TrainingRows& rows, Grouping by);

/// Groups the rows by run if that gives `least` groups or more, else by cycle,
/// else by leg, else by segment.
RowGroups coarsest_groups(const TrainingRows& rows, int least);

/// Returns which way the temperature went over the leg of each row: 1 up, -1
/// down, 0 where it did not move by kLegReversal.
Eigen::ArrayXi leg_directions(const TrainingRows& rows);

/// Largest share of the temperatures that may be in one group alone.
constexpr double kLargestAlone = 0.25;  // [-]

/// Returns whether the other groups still cover the temperatures when any one
/// group is held out: no group is alone in more than kLargestAlone of the
/// tenths of the span that have rows. Otherwise a fit to the others says
/// nothing about a fit to all.
bool others_cover(const TrainingRows& rows, const RowGroups& groups);

/// Smallest share of the temperatures that a separate leg spans.
constexpr double kLeastLeg = 0.25;  // [-]

/// Returns the groups to hold out in turn: coarsest_groups() for which
/// others_cover() holds, or two legs for which it holds, before segments. A leg
/// below kLeastLeg, such as self-heating before the chamber cools, joins the
/// neighbour of the same power cycle that spans more, if there are two legs or
/// more above kLeastLeg.
RowGroups folds_of(const TrainingRows& rows, int least);

}  // namespace beamgyro::internal
