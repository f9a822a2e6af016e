// SPDX-License-Identifier: MIT
#include "compensation/row_groups.h"

#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXi;
using Eigen::Index;

constexpr int kSegments = 5;
constexpr Index kLeastRows = 2;

ArrayXi segments(Index rows) {
  ArrayXi result(rows);
  for (Index k = 0; k < rows; ++k)
    result(k) = static_cast<int>(k * kSegments / rows);
  return result;
}

ArrayXi labels(const TrainingRows& rows, Grouping by) {
  switch (by) {
    case Grouping::kRun:
      return rows.run;
    case Grouping::kCycle:
      return rows.cycle;
    case Grouping::kLeg:
      return rows.leg;
    case Grouping::kSegment:
      break;
  }
  return segments(rows.size());
}

}  // namespace

std::string grouping_name(Grouping by) {
  switch (by) {
    case Grouping::kRun:
      return "run";
    case Grouping::kCycle:
      return "cycle";
    case Grouping::kLeg:
      return "leg";
    case Grouping::kSegment:
      break;
  }
  return "segment";
}

RowGroups group_rows(const TrainingRows& rows, Grouping by) {
  const ArrayXi label = labels(rows, by);
  RowGroups groups{by, ArrayXi(rows.size()), 0};
  for (Index begin = 0; begin < rows.size();) {
    Index end = begin;
    while (end < rows.size() && label(end) == label(begin)) ++end;
    if (end - begin >= kLeastRows || groups.count == 0) ++groups.count;
    groups.of_row.segment(begin, end - begin).setConstant(groups.count - 1);
    begin = end;
  }
  return groups;
}

RowGroups coarsest_groups(const TrainingRows& rows, int least) {
  for (const Grouping by : {Grouping::kRun, Grouping::kCycle, Grouping::kLeg}) {
    RowGroups groups = group_rows(rows, by);
    if (groups.count >= least) return groups;
  }
  if (RowGroups legs = group_rows(rows, Grouping::kLeg); legs.count > 1)
    return legs;
  return group_rows(rows, Grouping::kSegment);
}

}  // namespace beamgyro
