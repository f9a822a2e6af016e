// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "compensation/training_rows.h"

namespace beamgyro {

/// What is held out as a whole. Random samples are no such thing: neighbours
/// in time share the drift.
enum class Grouping {
  kRun,      // recordings
  kCycle,    // times from power-on to the loss of power
  kLeg,      // between reversals of the temperature
  kSegment,  // fifths of the rows in their order, where there is nothing else
};

std::string grouping_name(Grouping by);  // "run", "cycle", "leg", "segment"

struct RowGroups {
  Grouping by = Grouping::kRun;
  Eigen::ArrayXi of_row;  // 0 ... count - 1
  int count = 0;
};

/// The groups of at least 2 rows each: a smaller one joins the one before it.
RowGroups group_rows(const TrainingRows& rows, Grouping by);

/// By run where that gives `least` groups or more, else by cycle, else by leg
/// if there are two, and in the end by segment.
RowGroups coarsest_groups(const TrainingRows& rows, int least);

}  // namespace beamgyro
