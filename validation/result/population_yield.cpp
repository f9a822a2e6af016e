// SPDX-License-Identifier: MIT
#include "validation/result/population_yield.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>

#include "parallel/work_queue.h"
#include "sim/numerics/simulation_failure.h"
#include "statistics/intervals.h"
#include "validation/external/file_compensator.h"
#include "validation/result/judgement.h"

namespace beamgyro::internal {
namespace {

// Returns the qualification with the runs that the metrics read.
Qualification shortened_to(const Qualification& whole,
                           const std::vector<std::string>& names) {
  Qualification shortened = whole;
  shortened.runs.clear();
  for (const QualificationRun& run : whole.runs) {
    const bool is_read = std::ranges::any_of(names, [&](const auto& name) {
      const auto named = whole.metric_runs.find(name);
      return named != whole.metric_runs.end()
                 ? std::ranges::count(named->second, run.name) > 0
                 : std::ranges::count(find_metric(name)->reads, run.purpose) >
                       0;
    });
    if (is_read) shortened.runs.push_back(run);
  }
  return shortened;
}

struct DeviceOutcome {
  DeviceVerdict verdict;
  std::vector<MetricResult> metrics = {};
  bool is_simulated = true;
};

DeviceVerdict failed(const std::string& words) {
  return {Conformity::kFail, words.substr(0, words.find('\n'))};
}

DeviceVerdict verdict_on(const std::vector<DecidedLimit>& limits) {
  std::vector<Conformity> results;
  for (const auto& [limit, decision] : limits)
    results.push_back(decision.result);
  DeviceVerdict verdict{worst_of(results)};
  if (verdict.verdict == Conformity::kPass) return verdict;
  const auto& [limit, decision] = limits[static_cast<std::size_t>(
      std::ranges::find(results, verdict.verdict) - results.begin())];
  verdict.words = fmt::format("{}: {}", limit.metric, decision.words);
  return verdict;
}

class PopulationJudge {
 public:
  explicit PopulationJudge(const PopulationTask& task) : task_(task) {
    std::set<std::string> names;
    for (const Limit& limit : task.specification->limits) {
      names.insert(limit.metric);
      if (!limit.relative_to.empty() && limit.relative_to != "before")
        needs_baselines_ = true;
    }
    if (!task.specification->better_than.empty())
      names.insert("residual_rms_deg_per_s");
    for (const Metric& metric : metrics())
      if (names.contains(std::string(metric.name)))
        names_.emplace_back(metric.name);
    qualification_ = shortened_to(*task.qualification, names_);
  }

  const std::vector<std::string>& metric_names() const { return names_; }

  DeviceOutcome outcome_of_device(std::uint32_t number) const {
    const VirtualDevice drawn = task_.campaign->device(number);
    if (!drawn.device) return {failed(drawn.failure), {}, false};
    try {
      return judged({*drawn.device, task_.campaign->device_document->text(),
                     drawn.overrides, number});
    } catch (const SimulationFailure& error) {
      return {failed(error.what()), {}, false};
    }
  }

 private:
  DeviceOutcome judged(const QualifiedDevice& device) const {
    TrainingData data;
    if (task_.model != nullptr || needs_baselines_)
      data = training_data(*task_.qualification, device, task_.model, 1);
    std::unique_ptr<TestedCompensator> own;
    if (task_.model != nullptr) {
      try {
        own = tested(trained_on(data, *task_.model));
      } catch (const std::invalid_argument& error) {
        return {failed(fmt::format("cannot be trained: {}", error.what()))};
      }
    }
    const DeviceEvidence found =
        device_evidence(qualification_, device, own ? *own : *task_.compensator,
                        needs_baselines_ ? data : TrainingData{},
                        own != nullptr || task_.known != nullptr, 1);
    DeviceOutcome outcome;
    outcome.metrics =
        metric_results(found, qualification_.metric_runs, names_, 1);
    outcome.verdict =
        verdict_on(decided_limits(*task_.specification, outcome.metrics));
    const std::string no_use =
        words_of_no_use(comparisons_of(*task_.specification, found));
    if (!no_use.empty()) outcome.verdict = failed(no_use);
    return outcome;
  }

  const PopulationTask& task_;
  std::vector<std::string> names_;  // of the metrics that have a limit
  bool needs_baselines_ = false;
  Qualification qualification_;  // with the runs that they read
};

double value_or_nan(const std::optional<Estimate>& estimate) {
  return estimate ? estimate->value : std::numeric_limits<double>::quiet_NaN();
}

void count(const std::vector<DeviceOutcome>& outcomes,
           PopulationYield& result) {
  for (const DeviceOutcome& outcome : outcomes) {
    result.devices.push_back(outcome.verdict);
    switch (outcome.verdict.verdict) {
      case Conformity::kPass:
        ++result.passed;
        break;
      case Conformity::kFail:
        ++result.failed;
        break;
      case Conformity::kUndecided:
        ++result.undecided;
        break;
    }
    if (!outcome.is_simulated) ++result.not_simulated;
  }
  result.interval = clopper_pearson(static_cast<double>(result.passed),
                                    static_cast<double>(outcomes.size()));
}

}  // namespace

PopulationYield population_yield(const PopulationTask& task,
                                 std::size_t threads,
                                 const ProgressOfWork& progress) {
  const PopulationJudge population(task);
  const std::uint32_t devices = task.campaign->devices;
  std::vector<DeviceOutcome> outcomes(devices);
  std::atomic<std::uint32_t> done = 0;
  for_each_task(devices, threads, [&](std::size_t k, std::size_t) {
    outcomes[k] = population.outcome_of_device(static_cast<std::uint32_t>(k));
    ++done;
    if (progress) progress(static_cast<double>(done) / devices);
  });

  PopulationYield result;
  result.campaign = task.campaign->name;
  result.trained_on_each = task.model != nullptr;
  count(outcomes, result);
  for (std::size_t m = 0; m < population.metric_names().size(); ++m) {
    PopulationMetric metric{find_metric(population.metric_names()[m]), {}, {}};
    for (const DeviceOutcome& outcome : outcomes) {
      const bool has = m < outcome.metrics.size();
      metric.before.push_back(has ? value_or_nan(outcome.metrics[m].before)
                                  : value_or_nan({}));
      metric.after.push_back(has ? value_or_nan(outcome.metrics[m].after)
                                 : value_or_nan({}));
    }
    result.metrics.push_back(std::move(metric));
  }
  return result;
}

}  // namespace beamgyro::internal
