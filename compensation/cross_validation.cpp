// SPDX-License-Identifier: MIT
#include "compensation/cross_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>
#include <thread>

namespace beamgyro {
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
using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>;
Mask covered_by_others(const TrainingRows& rows, const RowGroups& groups) {
  Mask covered = Mask::Constant(rows.size(), false);
  for (int group = 0; group < groups.count; ++group) {
    const Mask own = groups.of_row == group;
    const double infinity = std::numeric_limits<double>::infinity();
    const double lowest = own.select(infinity, rows.temperature).minCoeff();
    const double highest = own.select(-infinity, rows.temperature).maxCoeff();
    const Mask between =
        own && rows.temperature >= lowest && rows.temperature <= highest;
    covered = own.select(between.any() ? between : own, covered);
  }
  return covered;
}

struct Fold {
  TrainingRows rows, unseen;
};

Fold fold_without(int group, const TrainingRows& rows, const RowGroups& groups,
                  const Mask& covered) {
  Fold fold;
  fold.rows = selected(rows, groups.of_row != group);
  fold.rows.range = {fold.rows.temperature.minCoeff(),
                     fold.rows.temperature.maxCoeff()};
  fold.unseen = selected(rows, covered && groups.of_row == group);
  return fold;
}

FitSpec as_in_fold(FitSpec kind, int cores) {
  if (auto* bp = std::get_if<BpSpec>(&kind)) {
    bp->training.restarts = std::min(bp->training.restarts, kFoldRestarts);
    bp->training.cores = cores;
  }
  return kind;
}

// Folds by number on several threads; of those that fail the first is told.
class FoldWork {
 public:
  FoldWork(int count, int threads)
      : count_(count),
        cores_(threads > 0 ? threads
                           : static_cast<int>(std::max(
                                 1u, std::thread::hardware_concurrency()))),
        at_once_(std::min(cores_, count)) {}

  int cores_of_each() const { return std::max(1, cores_ / at_once_); }

  template <class F>
  void run(const F& fold) {
    std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count_));
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int k = next++; k < count_; k = next++) {
        try {
          fold(k);
        } catch (...) {
          failures[static_cast<std::size_t>(k)] = std::current_exception();
        }
      }
    };
    {
      std::vector<std::jthread> others;
      for (int n = 1; n < at_once_; ++n) others.emplace_back(work);
      work();
    }
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }

 private:
  int count_, cores_, at_once_;
};

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

GroupErrors cross_validate(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads) {
  if (groups.count < 2)
    throw std::invalid_argument(fmt::format(
        "cross-validation by {} needs two or more; the recordings have {}",
        grouping_name(groups.by), groups.count));
  GroupErrors errors(groups.count);
  const Mask covered = covered_by_others(rows, groups);
  FoldWork work(groups.count, threads);
  const FitSpec cheap = as_in_fold(kind, work.cores_of_each());
  work.run([&](int group) {
    try {
      const Fold fold = fold_without(group, rows, groups, covered);
      const Fit fit = fit_model(cheap, inputs, fold.rows, {}, seed);
      const double rms = rms_residual(
          fit.model, clamped(fold.unseen, inputs, fold.rows.range));
      errors(group) = rms * rms;
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("without {} {}: {}",
                                              grouping_name(groups.by),
                                              group + 1, error.what()));
    }
  });
  return errors;
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
