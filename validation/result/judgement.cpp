// SPDX-License-Identifier: MIT
#include "validation/result/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "parallel/work_queue.h"
#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"

namespace beamgyro::internal {
namespace {

// Evaluates a metric on the runs that the qualification names for it. A metric
// without names takes those of its purposes itself.
std::optional<Estimate> evaluated(const Metric& metric, const Evidence& all,
                                  const MetricRuns& runs) {
  const auto named = runs.find(metric.name);
  if (named == runs.end()) return metric.evaluate(all);
  Evidence read{{}, all.full_scale};
  for (const EvidenceRun& run : all.runs)
    if (std::ranges::count(named->second, run.name) > 0)
      read.runs.push_back(run);
  return metric.evaluate(read);
}

const Estimate* estimate_of(const MetricResult& result,
                            const std::string& reference) {
  const auto pointer = [](const std::optional<Estimate>& estimate) {
    return estimate ? &*estimate : nullptr;
  };
  if (reference == "before") return pointer(result.before);
  for (const BaselineEstimate& baseline : result.baselines)
    if (baseline.name == reference) return pointer(baseline.estimate);
  return nullptr;
}

std::optional<Estimate> copied(const Estimate* estimate) {
  return estimate == nullptr ? std::nullopt : std::optional(*estimate);
}

struct Reasons {
  std::vector<std::string> against, open;
};

Reasons reasons_of(const std::vector<DecidedLimit>& limits,
                   const std::vector<CheckResult>& checks) {
  Reasons reasons;
  for (const auto& [limit, decision] : limits) {
    // A metric may have a limit of its own and some relative to other rates.
    const auto add = [&name = limit.metric](std::vector<std::string>& names) {
      if (std::ranges::count(names, name) == 0) names.push_back(name);
    };
    if (decision.result == Conformity::kFail) add(reasons.against);
    if (decision.result == Conformity::kUndecided) add(reasons.open);
  }
  for (const CheckResult& check : checks)
    if (check.outcome == CheckOutcome::kFailed)
      reasons.against.push_back(check.name);
  if (reasons.against.empty() && outcome_of(checks) == CheckOutcome::kNotTested)
    for (const CheckResult& check : checks)
      if (check.outcome == CheckOutcome::kNotTested && !may_be_untested(check))
        reasons.open.push_back(check.name);
  return reasons;
}

}  // namespace

std::vector<MetricResult> metric_results(const DeviceEvidence& found,
                                         const MetricRuns& runs,
                                         std::span<const std::string> names,
                                         std::size_t threads) {
  std::vector<MetricResult> results;
  const bool has_sigma = states_sigma(found.after);
  for (const Metric& metric : metrics()) {
    if (!names.empty() && std::ranges::count(names, metric.name) == 0) continue;
    if (names.empty() && metric.is_of_sigma && !has_sigma) continue;
    results.push_back({&metric, {}, {}, {}});
    for (const Baseline& baseline : found.baselines)
      results.back().baselines.push_back({baseline.name, {}});
  }
  const std::size_t rates = 2 + found.baselines.size();
  for_each_task(
      results.size() * rates, threads, [&](std::size_t k, std::size_t) {
        MetricResult& result = results[k / rates];
        const std::size_t rate = k % rates;
        const Evidence& all = rate == 0   ? found.before
                              : rate == 1 ? found.after
                                          : found.baselines[rate - 2].evidence;
        std::optional<Estimate>& estimate =
            rate == 0   ? result.before
            : rate == 1 ? result.after
                        : result.baselines[rate - 2].estimate;
        estimate = evaluated(*result.metric, all, runs);
      });
  return results;
}

std::vector<DecidedLimit> decided_limits(
    const SpecificationFile& specification,
    const std::vector<MetricResult>& metrics) {
  std::vector<DecidedLimit> decided;
  for (const Limit& limit : specification.limits) {
    const auto result =
        std::ranges::find_if(metrics, [&](const MetricResult& one) {
          return one.metric->name == limit.metric;
        });
    std::optional<Estimate> after, reference;
    if (result != metrics.end()) {
      after = result->after;
      reference = copied(estimate_of(*result, limit.relative_to));
    }
    decided.push_back({limit, decide(limit, after, reference,
                                     specification.false_accept_risk)});
  }
  return decided;
}

WordedVerdict verdict_of(const std::vector<DecidedLimit>& limits,
                         const std::vector<CheckResult>& checks) {
  const auto [against, open] = reasons_of(limits, checks);
  if (!against.empty())
    return {Conformity::kFail,
            fmt::format("Not met: {}.", fmt::join(against, ", "))};
  if (!open.empty())
    return {
        Conformity::kUndecided,
        fmt::format("The evidence does not tell: {}.", fmt::join(open, ", "))};
  const auto passed = std::ranges::count_if(checks, &CheckResult::passed);
  return {Conformity::kPass,
          fmt::format("The compensator passes: {} limit{} met, {} check{} "
                      "passed.",
                      limits.size(), limits.size() == 1 ? "" : "s", passed,
                      passed == 1 ? "" : "s")};
}

CheckedCompensator checked_runs(const DeviceEvidence& found,
                                const TestedCompensator& compensator) {
  CheckedCompensator checked;
  checked.compensator = &compensator;
  checked.full_scale = found.before.full_scale;
  for (std::size_t k = 0; k < found.runs.size(); ++k)
    checked.runs.push_back({found.read[k].name, found.read[k].purpose,
                            &found.runs[k], found.answers[k],
                            found.read[k].sha256, found.read[k].device,
                            found.read[k].set_run});
  return checked;
}

void judge(const JudgedBy& by, const DeviceEvidence& found, std::size_t threads,
           ValidationResult& result) {
  result.metrics = metric_results(found, by.metric_runs, {}, threads);
  if (states_sigma(found.after))
    result.sigma = sigma_report(sigma_evidence(found.after));
  result.limits = decided_limits(by.specification, result.metrics);
  CheckedCompensator checked = checked_runs(found, by.compensator);
  checked.provenance = by.provenance;
  checked.set = by.set;
  result.checks = run_checks(checked, threads);
  WordedVerdict verdict = verdict_of(result.limits, result.checks);
  result.verdict = verdict.verdict;
  result.words = std::move(verdict.words);
}

}  // namespace beamgyro::internal
