// SPDX-License-Identifier: MIT
#include "validation/result/population_yield.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

#include "compensation/inputs/sample_ranges.h"
#include "parallel/work_queue.h"
#include "sim/numerics/simulation_failure.h"
#include "statistics/intervals.h"
#include "validation/external/compensator_source.h"
#include "validation/metrics/no_effect.h"
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
      return reads_run(*find_metric(name), whole.metric_runs, run.name,
                       run.purpose);
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
  return {Verdict::kFail, words.substr(0, words.find('\n'))};
}

// Names the first run in which the drive loop never locked after a power-on of
// some seconds; empty where there is none.
std::string words_of_no_lock(const DeviceEvidence& found) {
  constexpr double kLongEnough = 10.0;  // [s]
  for (std::size_t k = 0; k < found.runs.size(); ++k) {
    const Recording& run = found.runs[k];
    for (const SampleRange& on : powered_stretches(run))
      if (run.time[on.end - 1] - run.time[on.begin] >= kLongEnough &&
          std::all_of(run.status.begin() + static_cast<long>(on.begin),
                      run.status.begin() + static_cast<long>(on.end),
                      [](std::uint8_t status) {
                        return (status & kLoopNotLocked) != 0;
                      }))
        return fmt::format("the drive loop never locks in {} from {:g} s on",
                           found.read[k].name, run.time[on.begin]);
  }
  return "";
}

DeviceVerdict verdict_on(const std::vector<DecidedLimit>& limits) {
  std::vector<Verdict> results;
  for (const auto& [limit, decision] : limits)
    results.push_back(decision.result);
  DeviceVerdict verdict{worst_of(results)};
  if (verdict.verdict == Verdict::kPass) return verdict;
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
    DeviceEvidence found;
    try {
      found = device_evidence(qualification_, device,
                              own ? *own : *task_.compensator,
                              needs_baselines_ ? data : TrainingData{},
                              own != nullptr || task_.known != nullptr, 1);
    } catch (const std::invalid_argument& error) {
      return {failed(error.what())};
    }
    DeviceOutcome outcome;
    outcome.metrics =
        metric_results(found, qualification_.metric_runs, names_, 1);
    outcome.verdict =
        verdict_on(decided_limits(*task_.specification, outcome.metrics));
    for (const std::string& words :
         {words_of_no_use(comparisons_of(*task_.specification, found)),
          words_of_no_effect(found.before, found.after),
          words_of_no_lock(found)})
      if (!words.empty()) outcome.verdict = failed(words);
    return outcome;
  }

  const PopulationTask& task_;
  std::vector<std::string> names_;  // of the metrics that have a limit
  bool needs_baselines_ = false;
  Qualification qualification_;  // with the runs that they read
};

}  // namespace

void PopulationMetric::add(const MetricResult& device) {
  const auto value = [](const std::optional<Estimate>& estimate) {
    return estimate ? estimate->value : NAN;
  };
  before.push_back(value(device.before));
  after.push_back(value(device.after));
}

VerdictCount count_of(std::span<const Verdict> verdicts) {
  const auto number_of = [&](Verdict verdict) {
    return static_cast<std::size_t>(std::ranges::count(verdicts, verdict));
  };
  VerdictCount count{number_of(Verdict::kPass), number_of(Verdict::kFail),
                     number_of(Verdict::kUndecided)};
  count.interval = clopper_pearson(static_cast<double>(count.passed),
                                   static_cast<double>(verdicts.size()));
  return count;
}

std::vector<PopulationMetric> followed_metrics(
    const SpecificationFile& specification) {
  std::vector<PopulationMetric> followed;
  const auto add = [&](std::string_view name) {
    const Metric* metric = find_metric(name);
    if (std::ranges::count(followed, metric, &PopulationMetric::metric) == 0)
      followed.push_back({metric, {}, {}});
  };
  add("residual_rms_deg_per_s");
  for (const Limit& limit : specification.limits)
    if (!limit.is_own) add(limit.metric);
  return followed;
}

void add_figures(const ValidationResult& result,
                 std::vector<PopulationMetric>& metrics) {
  for (PopulationMetric& metric : metrics)
    for (const MetricResult& one : result.metrics)
      if (one.metric == metric.metric) metric.add(one);
}

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

  std::vector<Verdict> verdicts;
  PopulationYield result;
  result.campaign = task.campaign->name;
  result.trained_on_each = task.model != nullptr;
  for (const DeviceOutcome& outcome : outcomes) {
    result.devices.push_back(outcome.verdict);
    verdicts.push_back(outcome.verdict.verdict);
    if (!outcome.is_simulated) ++result.not_simulated;
  }
  static_cast<VerdictCount&>(result) = count_of(verdicts);
  for (std::size_t m = 0; m < population.metric_names().size(); ++m) {
    PopulationMetric metric{find_metric(population.metric_names()[m]), {}, {}};
    for (const DeviceOutcome& outcome : outcomes)
      metric.add(m < outcome.metrics.size() ? outcome.metrics[m]
                                            : MetricResult{});
    result.metrics.push_back(std::move(metric));
  }
  return result;
}

}  // namespace beamgyro::internal
