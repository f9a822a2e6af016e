// SPDX-License-Identifier: MIT
#include "compensation/row_groups.h"

#include <algorithm>
#include <set>
#include <vector>

namespace beamgyro {
namespace {

using Eigen::ArrayXi;
using Eigen::Index;

constexpr Grouping kIndependent[] = {Grouping::kRun, Grouping::kCycle,
                                     Grouping::kLeg};
constexpr int kSegments = 5;
constexpr Index kPieces = 20;
constexpr Index kLeastRows = 2;
constexpr int kTemperatureBins = 10;
constexpr double kSlowNoise = 0.05;  // [-], of n s^2

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

const ArrayXi& labels(const TrainingRows& rows, Grouping by) {
  if (by == Grouping::kRun) return rows.run;
  return by == Grouping::kCycle ? rows.cycle : rows.leg;
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
  if (by == Grouping::kSegment) return segments(rows.size());
  const ArrayXi& label = labels(rows, by);
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
  for (const Grouping by : kIndependent)
    if (RowGroups groups = group_rows(rows, by); groups.count >= least)
      return groups;
  return group_rows(rows, Grouping::kSegment);
}

bool others_cover(const TrainingRows& rows, const RowGroups& groups) {
  const double lowest = rows.temperature.minCoeff();
  const double span = rows.temperature.maxCoeff() - lowest;
  if (!(span > 0.0)) return true;
  std::vector<std::set<int>> in_bin(kTemperatureBins);
  for (Index k = 0; k < rows.size(); ++k) {
    const double share = (rows.temperature(k) - lowest) / span;
    const auto bin = std::min(static_cast<int>(share * kTemperatureBins),
                              kTemperatureBins - 1);
    in_bin[static_cast<std::size_t>(bin)].insert(groups.of_row(k));
  }
  std::erase_if(in_bin, [](const auto& bin) { return bin.empty(); });
  std::vector<int> alone(static_cast<std::size_t>(groups.count), 0);
  for (const std::set<int>& bin : in_bin)
    if (bin.size() == 1) ++alone[static_cast<std::size_t>(*bin.begin())];
  return *std::max_element(alone.begin(), alone.end()) <=
         kLargestAlone * static_cast<double>(in_bin.size());
}

RowGroups folds_of(const TrainingRows& rows, int least) {
  for (const Grouping by : kIndependent) {
    RowGroups groups = group_rows(rows, by);
    const bool enough =
        groups.count >= least || (by == Grouping::kLeg && groups.count == 2);
    if (enough && others_cover(rows, groups)) return groups;
  }
  return group_rows(rows, Grouping::kSegment);
}

bool moves_more_than_noise(const TrainingRows& rows) {
  double squares = 0.0, count = 0.0;
  for (Index k = 2; k < rows.size(); ++k) {
    if (rows.cycle(k) != rows.cycle(k - 2)) continue;
    const double second =
        rows.bias(k) - 2.0 * rows.bias(k - 1) + rows.bias(k - 2);
    squares += second * second;
    count += 1.0;
  }
  if (count == 0.0) return false;
  const double variance = (rows.bias - rows.bias.mean()).square().mean();
  return variance >
         kSlowNoise * static_cast<double>(rows.size()) * 0.5 * squares / count;
}

}  // namespace beamgyro
