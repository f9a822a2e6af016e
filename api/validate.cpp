// SPDX-License-Identifier: MIT
#include "include/beamgyro/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "api/checked_number.h"
#include "api/compensator_state.h"
#include "api/model_state.h"
#include "api/program_version.h"
#include "api/reported_progress.h"
#include "api/user_compensator.h"
#include "api/validation_texts.h"
#include "compensation/rows/recorded_runs.h"
#include "config/range.h"
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
        {std::string(metric.metric->name), std::string(metric.metric->unit),
         metric.before, metric.after,
         largest_allowed(validation.result, metric.metric->name)}));
  return json;
}

}  // namespace

ValidationTexts texts_of(const CompletedValidation& validation) {
  const nlohmann::ordered_json json = json_of(validation);
  return {json_text(json), verdict_report(validation.result), page_of(json)};
}

}  // namespace internal

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void require_one_subject(const ValidationOptions& options) {
  const int subjects = (options.device ? 1 : 0) +
                       (options.recordings.empty() ? 0 : 1) +
                       (options.set ? 1 : 0);
  if (subjects != 1)
    throw std::invalid_argument(fmt::format(
        "{} things to validate on; expected a device, recordings or a set",
        subjects));
  if (options.device && !options.qualification)
    throw std::invalid_argument(
        "qualification is missing; expected a qualification file, which says "
        "what the device goes through");
  if (!options.device && (options.qualification || options.campaign))
    throw std::invalid_argument(
        "a qualification or a campaign is for a simulated device; expected a "
        "device");
  if (!options.set && !(options.runs.empty() && options.devices.empty()))
    throw std::invalid_argument(
        "runs and devices choose from a set; expected a set, or none of them");
  if (options.full_scale && options.device)
    throw std::invalid_argument(
        "full_scale is for recordings; a device file says its own");
  if (options.campaign_devices && !options.campaign)
    throw std::invalid_argument(
        "campaign_devices needs a campaign, from which they are drawn");
}

void require_different(const std::vector<std::filesystem::path>& recordings) {
  std::vector<std::string> names;
  for (const std::filesystem::path& path : recordings)
    names.push_back(path.string());
  internal::require_different_runs(names);
}

internal::ValidationRequest request_of(const ValidationOptions& options) {
  require_one_subject(options);
  internal::check_number("full_scale", options.full_scale,
                         internal::positive());
  internal::ValidationRequest request;
  if (options.device) {
    request.device = options.device->name();
    request.given_device = {options.device->text(),
                            options.device->overrides()};
    request.qualification = *options.qualification;
  }
  request.runs = options.recordings;
  require_different(options.recordings);
  if (options.set) {
    request.set = options.set->directory();
    request.selection.runs = options.runs;
    request.selection.devices = options.devices;
    if (options.devices.empty())
      request.selection.part = internal::SetPartNumber::kTest;
  }
  request.full_scale = options.full_scale;
  request.specification = options.specification;
  request.workbench = options.workbench;
  request.campaign = options.campaign;
  if (options.campaign_devices) request.devices = *options.campaign_devices;
  request.program_version = internal::kProgramVersion;
  request.git_revision = internal::kGitRevision;
  return request;
}

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
  outcome.metrics = metrics_of(result);
  for (const internal::CheckResult& check : result.checks)
    outcome.checks.push_back({check.name, outcome_name(check.outcome),
                              check.value, check.limit, check.words});
  outcome.warnings = result.warnings;
  internal::ValidationTexts texts = internal::texts_of(validation);
  outcome.json = std::move(texts.json);
  outcome.text = std::move(texts.text);
  outcome.page = std::move(texts.page);
  return outcome;
}

ValidationOutcome validated(internal::ValidationRequest request,
                            const ValidationOptions& options) {
  const internal::Validator validator(std::move(request));
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
  internal::ValidationRequest request = request_of(options);
  request.compensator = compensator.name();
  internal::GivenCompensator given;
  if (const auto* file = dynamic_cast<const Compensator*>(&compensator)) {
    given.kind = "compensator";
    given.trained = file->state().compensator;
    given.text = file->text();
  } else if (const auto* opened =
                 dynamic_cast<const internal::OpenedCompensator*>(
                     &compensator)) {
    request.compensator = opened->argument();  // with its process limits
    request.limits = opened->limits();
    return validated(std::move(request), options);
  } else {
    given.kind = "function";
    given.tested = internal::tested(compensator);
  }
  request.given = std::move(given);
  return validated(std::move(request), options);
}

ValidationOutcome validate(const Model& model,
                           const ValidationOptions& options) {
  internal::ValidationRequest request = request_of(options);
  request.compensator = model.name();
  request.given = internal::GivenCompensator{
      .model = model.state().spec, .kind = "model", .text = model.text()};
  return validated(std::move(request), options);
}

}  // namespace beamgyro
