// SPDX-License-Identifier: MIT
#include "validation/result/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/compensator/run_comparison.h"
#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/residual_scores.h"
#include "parallel/work_queue.h"
#include "validation/metrics/no_effect.h"
#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kConstantOfRuns = "constant_of_runs";
constexpr const char* kStraightLines = "straight_lines";

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

bool is_required(const SpecificationFile& specification,
                 const std::string& name) {
  const std::string asked = name == kConstantOfRuns ? "constant" : name;
  return std::ranges::count(specification.better_than, asked) > 0;
}

std::string words_of_other(const ResidualComparison& comparison) {
  if (comparison.with == "before") return "no compensator";
  if (comparison.with == kConstantOfRuns)
    return "a constant fitted to these runs";
  if (comparison.with == "table") return "a table with straight lines";
  if (comparison.with == kStraightLines)
    return "straight lines between the soaks of the same data";
  return fmt::format("a {} trained on the same data", comparison.with);
}

std::string rms_words(const ResidualComparison& comparison) {
  return fmt::format(
      "{} {:.3g} deg/s rms are left, with the compensator {:.3g}",
      comparison.with == "before" ? "without it"
                                  : "with " + words_of_other(comparison),
      comparison.found.other_rms, comparison.found.rms);
}

// What stands against a compensator, and what is open.
struct Reasons {
  std::vector<std::string> against, open;  // names of limits and checks
  std::string no_use;
  const CheckResult* failed = nullptr;  // the first, or what explains it
  std::vector<const CheckResult*> untested;
};

std::string joined_sentences(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + " " + other;
}

void add_name(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::count(names, name) == 0) names.push_back(name);
}

// Whether a check that was not tested leaves the verdict open.
bool is_open(const SpecificationFile& specification, const CheckResult& check,
             const std::vector<CheckResult>& all) {
  if (may_be_untested(check)) return false;
  if (!specification.may_leave_untested) return true;
  // Without it only a rate table shows whether rates come out.
  return check.name == "injection" &&
         std::ranges::none_of(all, [](const CheckResult& other) {
           return other.name == "true_rate" && other.passed();
         });
}

Reasons reasons_of(const SpecificationFile& specification,
                   const ValidationResult& result) {
  Reasons reasons;
  for (const auto& [limit, decision] : result.limits) {
    // A metric may have a limit of its own and some relative to other rates.
    if (decision.result == Verdict::kFail)
      add_name(reasons.against, limit.metric);
    if (decision.result == Verdict::kUndecided)
      add_name(reasons.open, limit.metric);
  }
  reasons.no_use =
      joined_sentences(result.no_effect, words_of_no_use(result.comparisons));
  for (const ResidualComparison& one : result.comparisons)
    if (one.is_required && std::isinf(one.found.half_width))
      add_name(
          reasons.open,
          fmt::format("whether the compensator is better than {} (one minute "
                      "of samples has no interval)",
                      one.with == "before" ? "no compensator" : "a constant"));
  for (const CheckResult& check : result.checks) {
    if (check.outcome == CheckOutcome::kFailed) {
      add_name(reasons.against, check.name);
      // What comes of a temperature that is none shows in other checks, too.
      if (reasons.failed == nullptr || check.name == "temperature_input")
        reasons.failed = &check;
    }
    if (check.outcome != CheckOutcome::kNotTested) continue;
    reasons.untested.push_back(&check);
    if (is_open(specification, check, result.checks))
      add_name(reasons.open, check.name);
  }
  return reasons;
}

// Which simple methods are as good: a reader has to know that first.
std::string as_good_words(const std::vector<ResidualComparison>& comparisons) {
  // Where there are soaks, the table of bins says the same twice.
  const bool has_lines = std::ranges::any_of(
      comparisons, [](const ResidualComparison& comparison) {
        return comparison.with == kStraightLines;
      });
  std::vector<std::string> words;
  for (const ResidualComparison& comparison : comparisons) {
    const bool is_simple = comparison.with == "cubic" ||
                           comparison.with == kStraightLines ||
                           (comparison.with == "table" && !has_lines);
    if (is_simple && !comparison.is_same && !comparison.found.is_better())
      words.push_back(rms_words(comparison));
  }
  if (words.empty()) return "";
  return fmt::format("No better than a simple method: {}. ",
                     fmt::join(words, "; "));
}

std::string failure_words(const Reasons& reasons) {
  if (reasons.against.empty()) return reasons.no_use;
  std::string words = joined_sentences(
      reasons.no_use,
      fmt::format("Not met: {}.", fmt::join(reasons.against, ", ")));
  if (reasons.failed != nullptr) words += " " + reasons.failed->words;
  return words;
}

std::string names_of(const std::vector<const CheckResult*>& checks) {
  std::vector<std::string> names;
  for (const CheckResult* check : checks) names.push_back(check->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string number_words(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string pass_words(const ValidationResult& result, const Reasons& reasons) {
  const auto passed = static_cast<std::size_t>(
      std::ranges::count_if(result.checks, &CheckResult::passed));
  std::vector<std::string> parts;
  for (const ResidualComparison& comparison : result.comparisons)
    if (comparison.is_required) {
      parts.push_back(fmt::format("better than {} ({:.3g} of {:.3g} deg/s rms)",
                                  words_of_other(comparison),
                                  comparison.found.rms,
                                  comparison.found.other_rms));
    }
  if (!result.limits.empty()) {
    const auto before = std::ranges::count_if(
        result.limits,
        [](const DecidedLimit& one) { return one.decision.met_before; });
    parts.push_back(number_words(result.limits.size(), "limit") + " met");
    if (before > 0)
      parts.back() += fmt::format(" ({} of them before compensation)", before);
  }
  parts.push_back(number_words(passed, "check") + " passed");
  std::string words =
      fmt::format("{}The compensator passes: {}",
                  as_good_words(result.comparisons), fmt::join(parts, ", "));
  if (!reasons.untested.empty())
    words += fmt::format(", {} not tested ({})", reasons.untested.size(),
                         names_of(reasons.untested));
  return words + ".";
}

std::string next_after_failure(const Reasons& reasons) {
  if (reasons.failed != nullptr)
    return std::string(definition_of(*reasons.failed).mend);
  if (!reasons.no_use.empty())
    return "train over the temperatures of these runs, and look whether their "
           "temperature is that of this gyro";
  return "lower the figures of the limits that are not met: their lines above "
         "say by how much";
}

std::string test_of(const CheckResult& check) {
  return fmt::format("add {}: it tests {}", definition_of(check).test,
                     check.name);
}

}  // namespace

std::vector<MetricResult> metric_results(const DeviceEvidence& found,
                                         const MetricRuns& runs,
                                         std::span<const std::string> names,
                                         std::size_t threads) {
  std::vector<MetricResult> results;
  const bool has_sigma = states_sigma(found.after);
  std::vector<const Baseline*> baselines;
  for (const Baseline& baseline : found.baselines)
    if (baseline.has_metrics) baselines.push_back(&baseline);
  for (const Metric& metric : metrics()) {
    if (!names.empty() && std::ranges::count(names, metric.name) == 0) continue;
    if (names.empty() && metric.is_of_sigma && !has_sigma) continue;
    results.push_back({&metric, {}, {}, {}});
    for (const Baseline* baseline : baselines)
      results.back().baselines.push_back({baseline->name, {}});
  }
  const std::size_t rates = 2 + baselines.size();
  for_each_task(
      results.size() * rates, threads, [&](std::size_t k, std::size_t) {
        MetricResult& result = results[k / rates];
        const std::size_t rate = k % rates;
        const Evidence& all = rate == 0   ? found.before
                              : rate == 1 ? found.after
                                          : baselines[rate - 2]->evidence;
        std::optional<Estimate>& estimate =
            rate == 0   ? result.before
            : rate == 1 ? result.after
                        : result.baselines[rate - 2].estimate;
        estimate = evaluated(*result.metric, all, runs);
      });
  return results;
}

std::vector<RunResidual> run_residuals(const DeviceEvidence& found) {
  std::vector<RunResidual> runs;
  for (std::size_t k = 0; k < found.read.size(); ++k) {
    const auto rms = [](const EvidenceRun& run) {
      return residual_scores(
                 block_residuals(score_blocks(*run.recording), run.rate,
                                 column_values(*run.recording, "true_rate")))
          .rms;
    };
    runs.push_back({found.read[k].name,
                    std::string(purpose_name(found.read[k].purpose)),
                    rms(found.before.runs[k]), rms(found.after.runs[k])});
  }
  return runs;
}

std::vector<ResidualComparison> comparisons_of(
    const SpecificationFile& specification, const DeviceEvidence& found) {
  const LeftDrift own = left_drift(found.after);
  const LeftDrift before = left_drift(found.before);
  std::vector<ResidualComparison> all;
  const auto add = [&](const std::string& name, const LeftDrift& other) {
    const auto compared = paired_residual(own, other);
    if (!compared) return;
    const bool is_same = std::ranges::equal(
        own.means, other.means,
        [](double a, double b) { return std::abs(a - b) < 1e-9; });
    all.push_back({name, *compared, is_required(specification, name), is_same});
  };
  add("before", before);
  for (const Baseline& baseline : found.baselines)
    if (baseline.name != "none" && baseline.name != "spline")
      add(baseline.name, left_drift(baseline.evidence));
  if (temperature_span(found.before) >= kLeastSpanOfRuns)
    add(kConstantOfRuns, without_mean(before));
  return all;
}

std::string words_of_no_use(
    const std::vector<ResidualComparison>& comparisons) {
  const ResidualComparison* least = nullptr;
  for (const ResidualComparison& one : comparisons)
    if (one.is_required && !one.found.is_better() &&
        std::isfinite(one.found.half_width) &&
        (least == nullptr || one.found.other_rms < least->found.other_rms))
      least = &one;
  return least == nullptr
             ? ""
             : fmt::format("Of no use on these runs: {}{}.", rms_words(*least),
                           least->found.gain > 0.0
                               ? ", a difference within its 95 % interval"
                               : "");
}

namespace {

void decide_without_seeds(const SpecificationFile& specification,
                          ValidationResult& result) {
  const Reasons reasons = reasons_of(specification, result);
  if (!reasons.no_use.empty() || !reasons.against.empty()) {
    result.verdict = Verdict::kFail;
    result.words = failure_words(reasons);
    result.next = next_after_failure(reasons);
    return;
  }
  if (!reasons.open.empty()) {
    result.verdict = Verdict::kUndecided;
    result.words = fmt::format("No run could decide on {}.",
                               fmt::join(reasons.open, ", "));
    const auto first =
        std::ranges::find_if(reasons.untested, [&](const CheckResult* check) {
          return std::ranges::count(reasons.open, check->name) > 0;
        });
    result.next = first != reasons.untested.end()
                      ? test_of(**first)
                      : "add runs, or longer ones: they narrow the intervals";
    return;
  }
  result.verdict = Verdict::kPass;
  result.words = pass_words(result, reasons);
  result.next = !reasons.untested.empty() ? test_of(*reasons.untested.front())
                : specification.may_leave_untested
                    ? "state limits of your own in a specification"
                    : "record the same runs with hardware";
}

// Runs of a set share the seed of their campaign and nothing else.
std::vector<std::string> shared_seeds(const Provenance* provenance,
                                      const DeviceEvidence& found) {
  std::vector<std::string> sentences;
  if (provenance == nullptr) return sentences;
  for (std::size_t k = 0; k < found.runs.size(); ++k) {
    if (!found.read[k].device.empty() ||
        was_used_in_training(*provenance, found.read[k].sha256, found.runs[k]))
      continue;
    const std::string words =
        shared_seed(*provenance, found.read[k].name, found.runs[k]);
    if (!words.empty()) sentences.push_back(words + ".");
  }
  return sentences;
}

}  // namespace

void decide_on(const SpecificationFile& specification,
               ValidationResult& result) {
  decide_without_seeds(specification, result);
  for (const std::string& words : result.shared_seeds)
    result.words += " " + words;
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
  result.own_metrics =
      own_metric_results(by.own_metrics, found.before, found.after);
  result.limits =
      decided_limits(by.specification, result.metrics, result.own_metrics);
  result.no_effect = words_of_no_effect(found.before, found.after);
  result.comparisons = comparisons_of(by.specification, found);
  result.runs = run_residuals(found);
  CheckedCompensator checked = checked_runs(found, by.compensator);
  checked.trained = by.trained;
  checked.provenance = by.compensator.provenance();
  checked.requires_provenance = by.requires_provenance;
  for (CheckedRun& run : checked.runs)
    run.is_limited =
        std::ranges::any_of(by.specification.limits, [&](const Limit& limit) {
          // A metric of the user's own is given every run.
          return limit.is_own ||
                 reads_run(*find_metric(limit.metric), by.metric_runs, run.name,
                           run.purpose);
        });
  checked.set = by.set;
  checked.declared = by.specification.declared;
  result.checks = run_checks(checked, threads);
  result.shared_seeds = shared_seeds(checked.provenance, found);
  decide_on(by.specification, result);
}

}  // namespace beamgyro::internal
