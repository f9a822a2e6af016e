// SPDX-License-Identifier: MIT
#include "compensation/training/cross_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "compensation/models/bias_function.h"
#include "parallel/work_queue.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
TrainingRows clamped(TrainingRows rows, const std::vector<Input>& inputs,
                     const TemperatureRange& range) {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (inputs[i].column == "temperature" &&
        inputs[i].kind != InputKind::kTemperatureRate) {
      auto column = rows.inputs.col(static_cast<Index>(i));
      column = column.max(range.lowest).min(range.highest).eval();
    }
  rows.temperature =
      rows.temperature.max(range.lowest).min(range.highest).eval();
  return rows;
}

// Rows between the temperatures of the other groups; all rows of a group that
// has none.
RowMask covered_by_others(const TrainingRows& rows, const RowGroups& groups) {
  RowMask covered = RowMask::Constant(rows.size(), false);
  for (int group = 0; group < groups.count; ++group) {
    const RowMask own = groups.of_row == group;
    const RowMask between = between_others(rows, groups, group);
    covered = own.select(between.any() ? between : own, covered);
  }
  return covered;
}

TrainingRows without_group(int group, const TrainingRows& rows,
                           const RowGroups& groups) {
  TrainingRows others = selected(rows, groups.of_row != group);
  others.range = {others.temperature.minCoeff(), others.temperature.maxCoeff()};
  return others;
}

FitSpec as_in_fold(FitSpec kind, int cores) {
  if (auto* bp = std::get_if<BpSpec>(&kind)) {
    bp->training.restarts = std::min(bp->training.restarts, kFoldRestarts);
    bp->training.cores = cores;
  }
  return kind;
}

}  // namespace

double rms_of(const GroupErrors& errors) { return std::sqrt(errors.mean()); }

double standard_error(const GroupErrors& errors) {
  if (errors.size() < 2) return std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(errors.size());
  return std::sqrt((errors - errors.mean()).square().sum() / (count - 1.0) /
                   count);
}

Predictions predict_all(const BiasModel& model, const TrainingRows& rows) {
  return {model.predict(rows.inputs), RowMask::Constant(rows.size(), true)};
}

RowMask between_others(const TrainingRows& rows, const RowGroups& groups,
                       int group) {
  const double infinity = std::numeric_limits<double>::infinity();
  const RowMask own = groups.of_row == group;
  const double lowest = own.select(infinity, rows.temperature).minCoeff();
  const double highest = own.select(-infinity, rows.temperature).maxCoeff();
  return own && rows.temperature >= lowest && rows.temperature <= highest;
}

GroupErrors group_errors(const Predictions& predictions, const ArrayXd& bias,
                         const RowGroups& groups) {
  const ArrayXd square = (bias - predictions.bias).square();
  GroupErrors sum = GroupErrors::Zero(groups.count), count = sum;
  for (Index k = 0; k < bias.size(); ++k) {
    if (!predictions.scored(k)) continue;
    sum(groups.of_row(k)) += square(k);
    count(groups.of_row(k)) += 1.0;
  }
  return sum / count;
}

Predictions predict_unseen(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads) {
  return {predict_others(kind, inputs, rows, groups, rows, groups.of_row, seed,
                         threads),
          covered_by_others(rows, groups)};
}

ArrayXd predict_others(const FitSpec& kind, const std::vector<Input>& inputs,
                       const TrainingRows& rows, const RowGroups& groups,
                       const TrainingRows& asked,
                       const Eigen::ArrayXi& group_of_asked, std::uint64_t seed,
                       int threads) {
  if (groups.count < 2)
    throw std::invalid_argument(fmt::format(
        "cross-validation by {} needs two or more; the recordings have {}",
        grouping_name(groups.by), groups.count));
  std::vector<ArrayXd> of_group(static_cast<std::size_t>(groups.count));
  const auto folds = static_cast<std::size_t>(groups.count);
  const std::size_t cores =
      thread_count(static_cast<unsigned>(std::max(threads, 0)));
  const std::size_t at_once = std::min(cores, folds);
  const FitSpec cheap = as_in_fold(kind, static_cast<int>(cores / at_once));
  for_each_task(folds, at_once, [&](std::size_t k, std::size_t) {
    const auto group = static_cast<int>(k);
    const auto without = [&](const std::exception& error) {
      return fmt::format("without {} {}: {}", grouping_name(groups.by),
                         group + 1, error.what());
    };
    try {
      const TrainingRows others = without_group(group, rows, groups);
      const Fit fit = fit_model(cheap, inputs, others, {}, seed);
      of_group[k] = fit.model.predict(
          clamped(selected(asked, group_of_asked == group), inputs,
                  others.range)
              .inputs.leftCols(static_cast<Index>(inputs.size())));
    } catch (const UndeterminedFit& error) {
      throw UndeterminedFit(without(error));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(without(error));
    }
  });
  ArrayXd bias(asked.size());
  std::vector<Index> next(of_group.size(), 0);
  for (Index k = 0; k < asked.size(); ++k) {
    const auto group = static_cast<std::size_t>(group_of_asked(k));
    bias(k) = of_group[group](next[group]++);
  }
  return bias;
}

Predictions averaged(const Predictions& constant, const Predictions& model,
                     double weight) {
  return {(1.0 - weight) * constant.bias + weight * model.bias, model.scored};
}

// With q the mean square of model - constant in a group and a the mean product
// of that with what the constant leaves, the errors are e(0) - 2 w a + w^2 q.
// Their mean is least at w = sum a / sum q, a ratio of means over the groups,
// whose variance is n/(n - 1) sum (a - w q)^2 / (sum q)^2. A group's own scale,
// w = a / q, leaves e(0) - a^2 / q of it.
StackingWeight stacking_weight(const Predictions& constant,
                               const Predictions& model, const ArrayXd& bias,
                               const RowGroups& groups) {
  const GroupErrors q = group_errors(model, constant.bias, groups);
  const GroupErrors flat = group_errors(constant, bias, groups);
  const GroupErrors left = group_errors(model, bias, groups);
  const GroupErrors a = 0.5 * (flat + q - left);
  if (!(q.sum() > 0.0)) return {0.0, 0.0, 0.0};
  const double weight = std::clamp(a.sum() / q.sum(), 0.0, 1.0);
  const auto count = static_cast<double>(groups.count);
  const GroupErrors by_own_scale =
      (q > 0.0).select(flat - a.square() / q, flat);
  return {weight,
          std::sqrt(count / (count - 1.0) * (a - weight * q).square().sum()) /
              q.sum(),
          left.sum() > 0.0 ? 1.0 - by_own_scale.sum() / left.sum() : 0.0};
}

bool is_clearly_less(const GroupErrors& model, const GroupErrors& other,
                     double least) {
  const GroupErrors gain = other - model;
  return rms_of(model) <= (1.0 - least) * rms_of(other) &&
         gain.mean() > standard_error(gain);
}

std::size_t choose(const std::vector<GroupErrors>& models) {
  const auto best = std::ranges::min_element(models, {}, rms_of);
  const double limit = (1.0 + kAllowedExcess) * rms_of(*best);
  const auto chosen = std::ranges::find_if(
      models, [&](const GroupErrors& model) { return rms_of(model) <= limit; });
  return static_cast<std::size_t>(std::min(chosen, best) - models.begin());
}

}  // namespace beamgyro::internal
