// SPDX-License-Identifier: MIT
#include "compensation/rows/row_groups.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXi;
using Eigen::Index;

constexpr Grouping kIndependent[] = {Grouping::kRun, Grouping::kCycle,
                                     Grouping::kLeg};
constexpr int kSegments = 5;
constexpr Index kPieces = 20;
constexpr Index kLeastRows = 2;

// Pieces of a leg in turn, so that each group spans it: held-out ends would
// ask for an extrapolation that a fit to all rows is never used for.
RowGroups segments(Index rows) {
  const Index pieces = std::min(kPieces, rows);
  RowGroups groups{Grouping::kSegment, ArrayXi(rows),
                   static_cast<int>(std::min<Index>(kSegments, rows))};
  for (Index k = 0; k < rows; ++k)
    groups.of_row(k) = static_cast<int>(k * pieces / rows % kSegments);
  return groups;
}

struct LegRows {
  Index begin, end;
  int cycle;
  bool is_short;
};

std::vector<LegRows> leg_rows(const TrainingRows& rows, const RowGroups& legs) {
  const auto span = [&](Index begin, Index end) {
    const auto part = rows.temperature.segment(begin, end - begin);
    return part.maxCoeff() - part.minCoeff();
  };
  const double least = kLeastLeg * span(0, rows.size());
  std::vector<LegRows> result;
  for (const auto& [begin, end] : stretches_of(legs.of_row))
    result.push_back({begin, end, rows.cycle(begin), span(begin, end) < least});
  return result;
}

// Returns the leg that a short leg joins: the next long one of its power cycle,
// else the last one before it, else itself.
std::size_t joined_leg(const std::vector<LegRows>& legs, std::size_t k) {
  const auto is_target = [&](std::size_t other) {
    return !legs[other].is_short && legs[other].cycle == legs[k].cycle;
  };
  if (!legs[k].is_short) return k;
  for (std::size_t next = k + 1; next < legs.size(); ++next)
    if (is_target(next)) return next;
  for (std::size_t before = k; before-- > 0;)
    if (is_target(before)) return before;
  return k;
}

RowGroups without_short_legs(const TrainingRows& rows,
                             const RowGroups& groups) {
  const std::vector<LegRows> legs = leg_rows(rows, groups);
  const auto is_long = [](const LegRows& leg) { return !leg.is_short; };
  if (std::ranges::count_if(legs, is_long) < 2) return groups;
  RowGroups joined{groups.by, ArrayXi(rows.size()), 0};
  std::vector<int> number(legs.size(), -1);
  for (std::size_t k = 0; k < legs.size(); ++k) {
    int& group = number[joined_leg(legs, k)];
    if (group < 0) group = joined.count++;
    joined.of_row.segment(legs[k].begin, legs[k].end - legs[k].begin)
        .setConstant(group);
  }
  return joined;
}

const ArrayXi& labels(const TrainingRows& rows, Grouping by) {
  if (by == Grouping::kRun) return rows.run;
  return by == Grouping::kCycle ? rows.cycle : rows.leg;
}

// For each tenth of the span of temperatures that has rows, their groups.
std::vector<std::set<int>> groups_in_tenths(const TrainingRows& rows,
                                            const ArrayXi& group_of_row) {
  const double lowest = rows.temperature.minCoeff();
  const double span = rows.temperature.maxCoeff() - lowest;
  std::vector<std::set<int>> tenths(10);
  for (Index k = 0; k < rows.size(); ++k) {
    const double share =
        span > 0.0 ? (rows.temperature(k) - lowest) / span : 0.0;
    const auto tenth =
        std::min(static_cast<std::size_t>(10.0 * share), tenths.size() - 1);
    tenths[tenth].insert(group_of_row(k));
  }
  std::erase_if(tenths, [](const auto& groups) { return groups.empty(); });
  return tenths;
}

}  // namespace

std::string grouping_name(Grouping by) {
  constexpr const char* kNames[] = {"run", "cycle", "leg", "segment"};
  return kNames[static_cast<std::size_t>(by)];
}

RowGroups group_rows(const TrainingRows& rows, Grouping by) {
  if (by == Grouping::kSegment) return segments(rows.size());
  RowGroups groups{by, ArrayXi(rows.size()), 0};
  for (const auto& [begin, end] : stretches_of(labels(rows, by))) {
    if (end - begin >= kLeastRows || groups.count == 0) ++groups.count;
    groups.of_row.segment(begin, end - begin).setConstant(groups.count - 1);
  }
  return groups;
}

RowGroups coarsest_groups(const TrainingRows& rows, int least) {
  for (const Grouping by : kIndependent)
    if (RowGroups groups = group_rows(rows, by); groups.count >= least)
      return groups;
  return group_rows(rows, Grouping::kSegment);
}

ArrayXi leg_directions(const TrainingRows& rows) {
  ArrayXi direction = ArrayXi::Zero(rows.size());
  for (const auto& [begin, end] : stretches_of(rows.leg)) {
    const double change = rows.temperature(end - 1) - rows.temperature(begin);
    if (std::abs(change) >= kLegReversal)
      direction.segment(begin, end - begin).setConstant(change > 0.0 ? 1 : -1);
  }
  return direction;
}

bool others_cover(const TrainingRows& rows, const RowGroups& groups) {
  const auto tenths = groups_in_tenths(rows, groups.of_row);
  if (rows.temperature.minCoeff() == rows.temperature.maxCoeff()) return true;
  std::vector<int> alone(static_cast<std::size_t>(groups.count), 0);
  for (const std::set<int>& tenth : tenths)
    if (tenth.size() == 1) ++alone[static_cast<std::size_t>(*tenth.begin())];
  return *std::max_element(alone.begin(), alone.end()) <=
         kLargestAlone * static_cast<double>(tenths.size());
}

RowGroups folds_of(const TrainingRows& rows, int least) {
  for (const Grouping by : kIndependent) {
    RowGroups groups = group_rows(rows, by);
    if (by == Grouping::kLeg) groups = without_short_legs(rows, groups);
    const bool enough =
        groups.count >= least || (by == Grouping::kLeg && groups.count == 2);
    if (enough && others_cover(rows, groups)) return groups;
  }
  return group_rows(rows, Grouping::kSegment);
}

}  // namespace beamgyro::internal
