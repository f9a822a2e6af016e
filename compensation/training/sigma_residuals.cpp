// SPDX-License-Identifier: MIT
#include "compensation/training/sigma_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "compensation/training/cross_validation.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXi;
using Eigen::Index;

constexpr double kSigmaRowSeconds = 60.0;  // [s], where rows are samples

// Groups of rows that share slow noise.
std::pair<ArrayXi, std::string> independent_groups(const TrainingRows& rows,
                                                   bool of_a_set) {
  if (of_a_set) return {rows.device, "device"};
  for (const Grouping by : {Grouping::kRun, Grouping::kCycle, Grouping::kLeg})
    if (RowGroups groups = group_rows(rows, by); groups.count >= 2)
      return {std::move(groups.of_row), grouping_name(by)};
  return {rows.run, grouping_name(Grouping::kRun)};
}

const LookupTable* scale_factor_of(const FittedCompensator& trained) {
  return trained.scale_factor ? &*trained.scale_factor : nullptr;
}

RowMask in_warm_up(const TrainingRows& rows) {
  return rows.inputs.col(rows.inputs.cols() - 2) >= kWarmUpShare;
}

ResidualRows residual_rows(const TrainingRows& rows, const ArrayXd& predicted,
                           ArrayXi group, std::string by, bool of_a_set) {
  const Index width = rows.inputs.cols() - 2;
  ResidualRows found{rows.temperature,       rows.bias - predicted,
                     rows.inputs.col(width), rows.inputs.col(width + 1),
                     std::move(group),       std::move(by)};
  if (!of_a_set) found.correlation = kBiasCorrelation;
  return found;
}

struct TimedGroup {
  double time;  // [s]
  int group;
};

// The group of the training row of the same run that is nearest in time; -1
// without one.
ArrayXi nearest_groups(const TrainingRows& rows, const RowGroups& groups,
                       const TrainingRows& asked) {
  std::map<int, std::vector<TimedGroup>> by_run;
  for (Index k = 0; k < rows.size(); ++k)
    by_run[rows.run(k)].push_back({rows.time(k), groups.of_row(k)});
  ArrayXi found(asked.size());
  for (Index k = 0; k < asked.size(); ++k) {
    const std::vector<TimedGroup>& own = by_run[asked.run(k)];
    const double time = asked.time(k);
    const auto after =
        std::ranges::lower_bound(own, time, {}, &TimedGroup::time);
    const bool takes_before =
        after == own.end() ||
        (after != own.begin() &&
         time - std::prev(after)->time < after->time - time);
    found(k) = own.empty()    ? -1
               : takes_before ? std::prev(after)->group
                              : after->group;
  }
  return found;
}

// Of each group, the temperatures of all others.
std::vector<TemperatureRange> ranges_of_others(const TrainingRows& rows,
                                               const RowGroups& groups) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<TemperatureRange> ranges;
  for (int group = 0; group < groups.count; ++group) {
    const RowMask own = groups.of_row == group;
    ranges.push_back({own.select(kInfinity, rows.temperature).minCoeff(),
                      own.select(-kInfinity, rows.temperature).maxCoeff()});
  }
  return ranges;
}

}  // namespace

bool has_several_devices(const SigmaTask& task) {
  return task.runs.set && (task.rows.device != task.rows.device(0)).any();
}

TrainingRows rows_with_ramps(const RunSource& runs, std::vector<Input> inputs,
                             const SigmaTask& task,
                             const TemperatureRange& range,
                             const LookupTable* scale_factor) {
  inputs.push_back({InputKind::kSincePowerOn, "", kSigmaTimeConstant});
  inputs.push_back(
      {InputKind::kTemperatureRate, "temperature", kSigmaTimeConstant});
  const double seconds = task.options.seconds;
  const RowOptions options{seconds > 0.0 ? seconds : kSigmaRowSeconds, {}};
  return training_rows(runs, inputs, options, range, scale_factor);
}

ResidualRows residuals_of(const FittedCompensator& trained,
                          const RunSource& runs, const SigmaTask& task) {
  const TrainingRows all =
      rows_with_ramps(runs, trained.inputs, task, trained.temperature_range,
                      scale_factor_of(trained));
  const TrainingRows rows =
      selected(all, all.beyond_range == 0.0 || in_warm_up(all));
  const bool held_out = &runs == &task.held_out_runs;
  const bool of_a_set = held_out && runs.set.has_value();
  auto [group, by] = held_out
                         ? independent_groups(rows, of_a_set)
                         : std::pair{group_rows(rows, Grouping::kLeg).of_row,
                                     grouping_name(Grouping::kLeg)};
  return residual_rows(
      rows, trained.bias.predict(rows.inputs.leftCols(rows.inputs.cols() - 2)),
      std::move(group), std::move(by), of_a_set);
}

std::optional<RowGroups> groups_to_leave_out(const SigmaTask& task) {
  if (has_several_devices(task)) return std::nullopt;
  RowGroups groups = task.groups ? *task.groups : folds_of(task.rows, 2);
  if (groups.by == Grouping::kSegment) return std::nullopt;
  return groups;
}

ResidualRows left_out_residuals(const FittedCompensator& trained,
                                const SigmaTask& task,
                                const RowGroups& groups) {
  const TrainingRows all =
      rows_with_ramps(task.runs, task.inputs, task, trained.temperature_range,
                      scale_factor_of(trained));
  const ArrayXi nearest = nearest_groups(task.rows, groups, all);
  const auto others = ranges_of_others(task.rows, groups);
  RowMask counts = all.beyond_range == 0.0 && nearest >= 0;
  for (Index k = 0; k < all.size(); ++k) {
    if (!counts(k)) continue;
    const auto& [lowest, highest] =
        others[static_cast<std::size_t>(nearest(k))];
    counts(k) = all.temperature(k) >= lowest && all.temperature(k) <= highest;
  }
  std::vector<Index> which;
  for (Index k = 0; k < all.size(); ++k)
    if (counts(k)) which.push_back(k);
  const TrainingRows asked = selected(all, counts);
  ArrayXi group = nearest(which);
  const ArrayXd predicted = predict_others(task.kind, task.inputs, task.rows,
                                           groups, asked, group, task.seed);
  ResidualRows found = residual_rows(asked, predicted, std::move(group),
                                     grouping_name(groups.by), false);
  // The next group is predicted by all, not by all but one: of independent
  // groups that leaves (1 + 1/G) in place of 1 + 1/(G - 1) of their variance.
  found.residual *= std::sqrt(1.0 - 1.0 / (groups.count * groups.count));
  return found;
}

}  // namespace beamgyro::internal
