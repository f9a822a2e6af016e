// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "compensation/training_rows.h"

namespace beamgyro {

/// What is held out as a whole. Random samples are no such thing: neighbours
/// in time share the drift.
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

/// The groups of at least 2 rows each: a smaller one joins the one before it.
RowGroups group_rows(const TrainingRows& rows, Grouping by);

/// By run where that gives `least` groups or more, else by cycle, else by leg,
/// and in the end by segment.
RowGroups coarsest_groups(const TrainingRows& rows, int least);

/// Groups with rows in each tenth of the span of temperatures; a tenth without
/// rows is left out.
std::vector<std::set<int>> groups_in_tenths(const TrainingRows& rows,
                                            const Eigen::ArrayXi& group_of_row);

/// Largest share of the temperatures that one group alone may hold.
constexpr double kLargestAlone = 0.25;  // [-]

/// Whether the others still cover the temperatures when any one group is held
/// out: of the tenths of the whole span that have rows, no group is alone in
/// more than kLargestAlone. Otherwise a fit to the others says nothing of a fit
/// to all.
bool others_cover(const TrainingRows& rows, const RowGroups& groups);

/// Least share of the temperatures that a leg spans to be one of its own.
constexpr double kLeastLeg = 0.25;  // [-]

/// What to hold out by turns: coarsest_groups() of which others_cover() the
/// temperatures, or two legs that do, before segments. A leg below kLeastLeg,
/// such as self-heating before the chamber cools, joins its neighbour of the
/// same power cycle that spans more, if two or more legs do.
RowGroups folds_of(const TrainingRows& rows, int least);

}  // namespace beamgyro
