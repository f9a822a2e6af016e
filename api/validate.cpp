// SPDX-License-Identifier: MIT
#include "include/beamgyro/validate.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/model_state.h"
#include "api/reported_progress.h"
#include "api/user_compensator.h"
#include "api/validation_texts.h"
#include "dataset/files/json_text.h"
#include "parallel/work_queue.h"
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

}  // namespace

ValidationTexts texts_of(const CompletedValidation& validation) {
  const nlohmann::ordered_json json = json_of(validation);
  return {json_text(json), verdict_report(validation.result, false),
          verdict_report(validation.result, true), page_of(json)};
}

}  // namespace internal

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

static_assert(static_cast<int>(Verdict::kPass) ==
                  static_cast<int>(internal::Conformity::kPass) &&
              static_cast<int>(Verdict::kFail) ==
                  static_cast<int>(internal::Conformity::kFail) &&
              static_cast<int>(Verdict::kUndecided) ==
                  static_cast<int>(internal::Conformity::kUndecided));

Verdict public_verdict(internal::Conformity conformity) {
  return static_cast<Verdict>(conformity);
}

std::optional<IntervalEstimate> estimate_of(
    const std::optional<internal::Estimate>& estimate) {
  if (!estimate) return std::nullopt;
  const internal::Interval interval =
      estimate->interval.value_or(internal::Interval{kNone, kNone});
  return IntervalEstimate{estimate->value, interval.low, interval.high};
}

std::vector<MetricRow> metrics_of(const internal::ValidationResult& result) {
  std::vector<MetricRow> rows;
  for (const internal::MetricResult& found : result.metrics) {
    MetricRow row{
        std::string(found.metric->name),   std::string(found.metric->unit),
        std::string(found.metric->clause), estimate_of(found.before),
        estimate_of(found.after),          {}};
    for (const auto& [limit, decision] : result.limits)
      if (limit.metric == found.metric->name)
        row.limits.push_back({internal::text_of(limit), limit.relative_to,
                              public_verdict(decision.result), decision.margin,
                              decision.words});
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string outcome_name(internal::CheckOutcome outcome) {
  switch (outcome) {
    case internal::CheckOutcome::kPassed:
      return "passed";
    case internal::CheckOutcome::kFailed:
      return "failed";
    case internal::CheckOutcome::kNotTested:
      break;
  }
  return "not tested";
}

ValidationOutcome public_outcome(
    const internal::CompletedValidation& validation) {
  const internal::ValidationResult& result = validation.result;
  ValidationOutcome outcome;
  outcome.verdict = public_verdict(result.verdict);
  outcome.words = result.words;
  outcome.next = result.next;
  outcome.metrics = metrics_of(result);
  for (const internal::CheckResult& check : result.checks)
    outcome.checks.push_back({check.name, outcome_name(check.outcome),
                              check.value, check.limit, check.words});
  outcome.warnings = result.warnings;
  internal::ValidationTexts texts = internal::texts_of(validation);
  outcome.json = std::move(texts.json);
  outcome.text = std::move(texts.text);
  outcome.all_metrics = std::move(texts.all_metrics);
  outcome.page = std::move(texts.page);
  return outcome;
}

ValidationOutcome validated(internal::CompensatorSource source,
                            const ValidationOptions& options) {
  const internal::Validator validator(std::move(source), options);
  std::mutex one_at_a_time;
  double reported = 0.0;
  internal::ProgressOfWork progress;
  if (options.progress)
    progress = [&](double share) {
      const std::lock_guard lock(one_at_a_time);
      // Threads may overtake each other on the way here.
      reported = std::max(reported, share);
      internal::report(options.progress, reported);
    };
  const internal::CompletedValidation found =
      validator.validate(internal::thread_count(options.jobs), progress);
  if (progress) progress(1.0);
  return public_outcome(found);
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  return internal::conformity_name(static_cast<internal::Conformity>(verdict));
}

ValidationOutcome validate(const RateCompensator& compensator,
                           const ValidationOptions& options) {
  return validated(internal::source_of(compensator), options);
}

ValidationOutcome validate(const Model& model,
                           const ValidationOptions& options) {
  return validated(
      internal::source_of(model.state().spec, model.name(), model.text()),
      options);
}

}  // namespace beamgyro
