// SPDX-License-Identifier: MIT
#include "compensation/cross_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

TrainingRows clamped(TrainingRows rows, const std::vector<Input>& inputs,
                     const TemperatureRange& range) {
  if (rows.size() == 0) return rows;
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

struct Fold {
  TrainingRows rows, stopping, unseen;
};

Fold fold_without(int group, const TrainingRows& rows, const RowGroups& groups,
                  bool stops_early) {
  const int stopping = stops_early ? (group + 1) % groups.count : -1;
  Fold fold;
  fold.rows =
      selected(rows, groups.of_row != group && groups.of_row != stopping);
  fold.rows.range = {fold.rows.temperature.minCoeff(),
                     fold.rows.temperature.maxCoeff()};
  if (stops_early) fold.stopping = selected(rows, groups.of_row == stopping);
  fold.unseen = selected(rows, groups.of_row == group);
  return fold;
}

}  // namespace

double rms_of(const GroupErrors& errors) { return std::sqrt(errors.mean()); }

double standard_error(const GroupErrors& errors) {
  if (errors.size() < 2) return std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(errors.size());
  return std::sqrt((errors - errors.mean()).square().sum() / (count - 1.0) /
                   count);
}

GroupErrors group_errors(const BiasModel& model, const TrainingRows& rows,
                         const RowGroups& groups) {
  const ArrayXd square = (rows.bias - model.predict(rows.inputs)).square();
  GroupErrors sum = GroupErrors::Zero(groups.count), count = sum;
  for (Index k = 0; k < rows.size(); ++k) {
    sum(groups.of_row(k)) += square(k);
    count(groups.of_row(k)) += 1.0;
  }
  return sum / count;
}

Unseen cross_validate(const FitSpec& kind, const std::vector<Input>& inputs,
                      const TrainingRows& rows, const RowGroups& groups,
                      std::uint64_t seed) {
  if (groups.count < 2)
    throw std::invalid_argument(fmt::format(
        "cross-validation by {} needs two or more; the recordings have {}",
        grouping_name(groups.by), groups.count));
  const bool stops_early =
      std::holds_alternative<BpSpec>(kind) && groups.count > 2;
  Unseen result{GroupErrors(groups.count), 0};
  std::vector<int> epochs;
  for (int group = 0; group < groups.count; ++group) {
    try {
      const Fold fold = fold_without(group, rows, groups, stops_early);
      const TemperatureRange& range = fold.rows.range;
      const Fit fit = fit_model(kind, inputs, fold.rows,
                                clamped(fold.stopping, inputs, range), seed);
      const double rms =
          rms_residual(fit.model, clamped(fold.unseen, inputs, range));
      result.errors(group) = rms * rms;
      epochs.push_back(fit.summary().best_epoch);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("without {} {}: {}",
                                              grouping_name(groups.by),
                                              group + 1, error.what()));
    }
  }
  const auto middle =
      epochs.begin() + static_cast<std::ptrdiff_t>(epochs.size() / 2);
  std::nth_element(epochs.begin(), middle, epochs.end());
  result.epochs = *middle;
  return result;
}

std::size_t choose(const std::vector<Scored>& models) {
  const auto best = std::min_element(models.begin(), models.end(),
                                     [](const Scored& a, const Scored& b) {
                                       return a.errors.mean() < b.errors.mean();
                                     });
  const double limit = rms_of(best->errors) * (1.0 + kAllowedExcess);
  const auto good_enough = [&](const Scored& model) {
    const GroupErrors excess = model.errors - best->errors;
    return excess.mean() <= standard_error(excess) &&
           rms_of(model.errors) <= limit;
  };
  const auto chosen = std::find_if(models.begin(), models.end(), good_enough);
  return static_cast<std::size_t>(std::min(chosen, best) - models.begin());
}

}  // namespace beamgyro
