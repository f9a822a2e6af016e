// SPDX-License-Identifier: MIT
#include "include/beamgyro/validate.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/compensators.h"
#include "api/reported_progress.h"
#include "api/validator.h"
#include "compensation/compensator/compensator_file.h"
#include "dataset/files/json_text.h"
#include "parallel/work_queue.h"
#include "random/system_seed.h"
#include "report/ci_report.h"
#include "report/verdict_report.h"
#include "validation/page/figures.h"
#include "validation/page/page.h"
#include "validation/result/result_json.h"
#include "validation/specification/decision.h"

namespace beamgyro {
namespace internal {
namespace {

// Returns the largest value that a specification allows a metric, if it does.
std::optional<double> largest_allowed(const ValidationResult& result,
                                      std::string_view metric) {
  for (const auto& [limit, decision] : result.limits)
    if (limit.metric == metric && limit.relative_to.empty() && limit.most)
      return limit.most;
  return std::nullopt;
}

nlohmann::ordered_json json_of(const CompletedValidation& validation) {
  nlohmann::ordered_json json = to_json(validation.result);
  json["figures"] =
      figures_of(validation.evidence.before, validation.evidence.after);
  if (validation.result.sigma)
    for (auto& figure : sigma_figures(*validation.result.sigma))
      json["figures"].push_back(std::move(figure));
  if (!validation.result.population) return json;
  for (const PopulationMetric& metric : validation.result.population->metrics)
    json["figures"].push_back(population_figure(
        metric, largest_allowed(validation.result, metric.metric->name)));
  return json;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::optional<IntervalEstimate> estimate_of(
    const std::optional<Estimate>& estimate) {
  if (!estimate) return std::nullopt;
  const Interval interval = estimate->interval.value_or(Interval{kNone, kNone});
  return IntervalEstimate{estimate->value, interval.low, interval.high};
}

std::vector<LimitResult> limits_on(const ValidationResult& result,
                                   std::string_view metric) {
  std::vector<LimitResult> rows;
  for (const auto& [limit, decision] : result.limits)
    if (limit.metric == metric)
      rows.push_back({text_of(limit), limit.relative_to, decision.result,
                      decision.margin, decision.words, decision.met_before});
  return rows;
}

std::vector<MetricRow> metrics_of(const ValidationResult& result) {
  std::vector<MetricRow> rows;
  for (const MetricResult& found : result.metrics)
    rows.push_back(
        {std::string(found.metric->name), std::string(found.metric->unit),
         std::string(found.metric->clause), estimate_of(found.before),
         estimate_of(found.after), limits_on(result, found.metric->name)});
  for (const OwnMetricResult& found : result.own_metrics)
    rows.push_back({found.name, found.unit, "", estimate_of(found.before),
                    estimate_of(found.after), limits_on(result, found.name)});
  return rows;
}

std::string outcome_name(CheckOutcome outcome) {
  switch (outcome) {
    case CheckOutcome::kPassed:
      return "passed";
    case CheckOutcome::kFailed:
      return "failed";
    case CheckOutcome::kNotTested:
      break;
  }
  return "not tested";
}

ValidationOutcome public_outcome(const CompletedValidation& validation) {
  const ValidationResult& result = validation.result;
  const nlohmann::ordered_json json = json_of(validation);
  ValidationOutcome outcome{.verdict = result.verdict,
                            .words = result.words,
                            .next = result.next,
                            .metrics = metrics_of(result),
                            .checks = {},
                            .warnings = result.warnings,
                            .text = verdict_report(result, false),
                            .all_metrics = verdict_report(result, true),
                            .json = json_text(json),
                            .page = page_of(json),
                            .junit = junit_report(result),
                            .lines = line_report(result),
                            .trained = {}};
  if (validation.trained)
    outcome.trained = compensator_text(*validation.trained);
  for (const CheckResult& check : result.checks)
    outcome.checks.push_back({check.name, outcome_name(check.outcome),
                              check.value, check.limit, check.words});
  return outcome;
}

}  // namespace

ValidationOutcome validated(const Validator& validator,
                            const Progress& progress) {
  std::mutex one_at_a_time;
  double reported = 0.0;
  const auto told = [&](double share) {
    const std::lock_guard lock(one_at_a_time);
    // Threads may overtake each other on the way here.
    reported = std::max(reported, share);
    report(progress, reported);
  };
  const CompletedValidation found =
      validator.validate(thread_count(validator.options().jobs), told);
  told(1.0);
  return public_outcome(found);
}

}  // namespace internal

std::uint64_t random_seed() { return internal::system_random_bits() >> 12; }

ValidationOutcome validate(const RateCompensator& compensator,
                           const ValidationOptions& options) {
  return validated(
      internal::Validator(internal::source_of(compensator), options),
      options.progress);
}

ValidationOutcome validate(const Model& model,
                           const ValidationOptions& options) {
  return validated(
      internal::Validator(
          internal::source_of(model.content(), model.name(), model.text()),
          options),
      options.progress);
}

}  // namespace beamgyro
