// SPDX-License-Identifier: MIT
#include "validation/result/result_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "validation/result/metric_change.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : Json();
}

Json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return {number_or_null(interval->low), number_or_null(interval->high)};
}

Json estimate_json(const std::optional<Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", number_or_null(estimate->value)},
          {"interval", interval_json(estimate->interval)}};
}

// A limit in the unit of its metric: a number, or both ends.
Json limit_json(const Limit& limit) {
  if (limit.least && limit.most) return {*limit.least, *limit.most};
  return limit.most ? *limit.most : *limit.least;
}

// The limits of one metric together: the value of the first that is not
// relative, every one in words, and the worst result.
void add_limits_of(const std::string_view metric,
                   const std::vector<DecidedLimit>& limits, Json& json) {
  Json value, words = Json::array();
  std::vector<Verdict> results;
  for (const auto& [limit, decision] : limits) {
    if (limit.metric != metric) continue;
    if (value.is_null() && limit.relative_to.empty()) value = limit_json(limit);
    words.push_back(text_of(limit));
    results.push_back(decision.result);
  }
  json["limit"] = value;
  json["limits"] = words;
  json["result"] =
      results.empty() ? Json() : Json(verdict_name(worst_of(results)));
}

Json metric_json(const MetricResult& result,
                 const std::vector<DecidedLimit>& limits) {
  const Metric& metric = *result.metric;
  Json json{{"name", metric.name},
            {"title", metric.title},
            {"unit", metric.unit},
            {"clause", metric.clause},
            {"definition", metric.definition},
            {"before", estimate_json(result.before)},
            {"after", estimate_json(result.after)}};
  Json& baselines = json["baselines"] = Json::object();
  for (const BaselineEstimate& baseline : result.baselines)
    baselines[baseline.name] = estimate_json(baseline.estimate);
  add_limits_of(metric.name, limits, json);
  return json;
}

Json own_metric_json(const OwnMetricResult& metric,
                     const std::vector<DecidedLimit>& limits) {
  Json json{{"name", metric.name},
            {"unit", metric.unit},
            {"before", estimate_json(metric.before)},
            {"after", estimate_json(metric.after)}};
  add_limits_of(metric.name, limits, json);
  return json;
}

Json decided_json(const DecidedLimit& decided) {
  const auto& [limit, decision] = decided;
  return {{"metric", limit.metric},
          {"min", number_or_null(limit.least)},
          {"max", number_or_null(limit.most)},
          {"absolute", limit.absolute},
          {"relative_to",
           limit.relative_to.empty() ? Json() : Json(limit.relative_to)},
          {"source", limit.source},
          {"own", limit.is_own},
          {"compared", estimate_json(decision.compared)},
          {"margin", number_or_null(decision.margin)},
          {"guard_band", number_or_null(decision.guard_band)},
          {"met_before", decision.met_before},
          {"result", verdict_name(decision.result)},
          {"words", decision.words}};
}

Json check_json(const CheckResult& check) {
  return {{"name", check.name},
          {"passed", check.outcome == CheckOutcome::kNotTested
                         ? Json()
                         : Json(check.passed())},
          {"value", number_or_null(check.value)},
          {"limit", number_or_null(check.limit)},
          {"words", check.words}};
}

Json gain_interval(const PairedResidual& found) {
  if (!std::isfinite(found.half_width)) return nullptr;
  return {found.gain - found.half_width, found.gain + found.half_width};
}

// The gain is the logarithm of the quotient of the mean squares.
Json comparison_json(const ResidualComparison& comparison) {
  const PairedResidual& found = comparison.found;
  return {{"with", comparison.with},
          {"rms_deg_per_s", found.other_rms},
          {"compensated_rms_deg_per_s", found.rms},
          {"gain", found.gain},
          {"interval", gain_interval(found)},
          {"better", found.is_better()},
          {"required", comparison.is_required}};
}

Json figures_json(std::span<const double> values) {
  Json numbers = Json::array();
  for (const double value : values) numbers.push_back(number_or_null(value));
  return numbers;
}

// The figures of every device, or with every seed.
Json followed_json(const std::vector<PopulationMetric>& followed) {
  Json json = Json::array();
  for (const PopulationMetric& metric : followed)
    json.push_back({{"name", metric.metric->name},
                    {"unit", metric.metric->unit},
                    {"before", figures_json(metric.before)},
                    {"after", figures_json(metric.after)}});
  return json;
}

Json seeds_json(const SeedVerdicts& seeds) {
  Json json{{"first", seeds.seeds.front().seed},
            {"count", seeds.seeds.size()},
            {"passed", seeds.passed},
            {"failed", seeds.failed},
            {"undecided", seeds.undecided},
            {"share", number_or_null(seeds.share())},
            {"interval", interval_json(seeds.interval)},
            {"shown_seed", seeds.shown}};
  for (const auto& [seed, verdict, words] : seeds.seeds)
    json["verdicts"].push_back(
        {{"seed", seed}, {"verdict", verdict_name(verdict)}, {"words", words}});
  json["metrics"] = followed_json(seeds.metrics);
  return json;
}

Json yield_json(const PopulationYield& population) {
  Json json{{"campaign", population.campaign},
            {"devices", population.devices.size()},
            {"trained_on_each", population.trained_on_each},
            {"passed", population.passed},
            {"failed", population.failed},
            {"undecided", population.undecided},
            {"not_simulated", population.not_simulated},
            {"yield", number_or_null(population.share())},
            {"interval", interval_json(population.interval)}};
  if (!population.shown.empty()) json["shown_device"] = population.shown;
  Json& devices = json["verdicts"] = Json::array();
  for (const DeviceVerdict& device : population.devices) {
    devices.push_back(
        {{"verdict", verdict_name(device.verdict)}, {"words", device.words}});
    if (!device.number.empty()) devices.back()["device"] = device.number;
  }
  json["metrics"] = followed_json(population.metrics);
  return json;
}

Json changes_json(const std::vector<MetricChange>& changes) {
  Json list = Json::array();
  for (const MetricChange& one : changes)
    list.push_back({{"name", one.metric->name},
                    {"title", one.metric->title},
                    {"unit", one.metric->unit},
                    {"own", estimate_json(one.own)},
                    {"other", estimate_json(one.other)},
                    {"difference", estimate_json(one.difference)},
                    {"change", change_name(one.change)}});
  return list;
}

Json compensator_json(const JudgedCompensator& compensator) {
  return {{"name", compensator.name},
          {"kind", compensator.kind},
          {"method", compensator.method},
          {"inputs", compensator.inputs}};
}

void add_decisions(const std::vector<DecidedLimit>& limits,
                   const std::vector<CheckResult>& checks, Json& json) {
  for (const char* list : {"limits", "checks"}) json[list] = Json::array();
  for (const DecidedLimit& limit : limits)
    json["limits"].push_back(decided_json(limit));
  for (const CheckResult& check : checks)
    json["checks"].push_back(check_json(check));
}

Json against_json(const SideBySide& other) {
  Json json{{"sentence", other.sentence},
            {"compensator", compensator_json(other.compensator)},
            {"verdict", verdict_name(other.verdict)},
            {"words", other.words},
            {"residual", nullptr},
            {"metrics", changes_json(other.metrics)}};
  if (other.residual)
    json["residual"] = {{"rms_deg_per_s", other.residual->other_rms},
                        {"compensated_rms_deg_per_s", other.residual->rms},
                        {"gain", other.residual->gain},
                        {"interval", gain_interval(*other.residual)}};
  add_decisions(other.limits, other.checks, json);
  return json;
}

Json baseline_json(const EarlierComparison& earlier) {
  return {{"file", earlier.name},
          {"verdict", earlier.verdict},
          {"worse", earlier.is_worse()},
          {"lost", earlier.lost},
          {"other_inputs", earlier.other_inputs},
          {"metrics", changes_json(earlier.metrics)}};
}

Json provenance_json(const ResultProvenance& provenance) {
  Json json{{"beamgyro_version", provenance.program_version},
            {"git_revision", provenance.git_revision},
            {"device", provenance.device},
            {"qualification", provenance.qualification},
            {"specification", provenance.specification},
            {"false_accept_risk", provenance.false_accept_risk}};
  if (provenance.seed) json["seed"] = *provenance.seed;
  Json& files = json["files"] = Json::array();
  for (const ResultFile& file : provenance.files)
    files.push_back(
        {{"group", file.group}, {"name", file.name}, {"sha256", file.sha256}});
  Json& seeds = json["seeds"] = Json::object();
  for (const auto& [run, seed] : provenance.seeds) seeds[run] = seed;
  return json;
}

Json fit_json(const SigmaFit& fit) {
  Json json{{"groups", fit.groups}, {"clusters", fit.clusters}};
  for (std::size_t k = 0; k < kCoverageLevels.size(); ++k)
    json["coverage"].push_back({{"level", kCoverageLevels[k]},
                                {"share", estimate_json(fit.coverage[k])}});
  json["pit"] = nullptr;
  if (fit.pit)
    json["pit"] = {{"histogram", figures_json(fit.pit->histogram)},
                   {"distance", number_or_null(fit.pit->distance)},
                   {"p_value", number_or_null(fit.pit->p_value)}};
  return json;
}

Json isolation_json(const std::optional<Isolation>& isolation) {
  if (!isolation) return nullptr;
  Json files = Json::array();
  for (const AllowedFile& file : isolation->files)
    files.push_back({{"name", file.name}, {"sha256", file.sha256}});
  return {{"isolated", isolation->holds()},
          {"words", isolation_words(*isolation)},
          {"files", files}};
}

}  // namespace

nlohmann::ordered_json sigma_json(const SigmaReport& report) {
  return {{"soaks", fit_json(report.soaks)},
          {"ramps", fit_json(report.ramps)},
          {"bias_filter",
           {{"updates", report.updates}, {"nis", estimate_json(report.nis)}}}};
}

nlohmann::ordered_json metrics_json(const std::vector<MetricResult>& metrics,
                                    const std::vector<DecidedLimit>& limits) {
  Json json = Json::array();
  for (const MetricResult& metric : metrics)
    json.push_back(metric_json(metric, limits));
  return json;
}

nlohmann::ordered_json to_json(const ValidationResult& result) {
  Json json{{"filetype", "beamgyro-validation"},
            {"verdict", verdict_name(result.verdict)},
            {"words", result.words},
            {"next", result.next},
            {"compensator", compensator_json(result.compensator)}};
  if (const auto& workbench = result.compensator.workbench) {
    Json& compensator = json["compensator"];
    compensator["workbench"] = workbench->name;
    compensator["workbench_difference_largest_deg_per_s"] = workbench->largest;
    compensator["workbench_difference_rms_deg_per_s"] = workbench->rms;
  }
  json["isolation"] = isolation_json(result.isolation);
  Json& compared = json["compared_with"] = Json::array();
  for (const ResidualComparison& one : result.comparisons)
    compared.push_back(comparison_json(one));
  Json& runs = json["runs"] = Json::array();
  for (const RunResidual& run : result.runs)
    runs.push_back({{"name", run.name},
                    {"purpose", run.purpose},
                    {"rms_deg_per_s",
                     {{"before", number_or_null(run.before)},
                      {"after", number_or_null(run.after)}}}});
  json["metrics"] = metrics_json(result.metrics, result.limits);
  Json& own_metrics = json["own_metrics"] = Json::array();
  for (const OwnMetricResult& metric : result.own_metrics)
    own_metrics.push_back(own_metric_json(metric, result.limits));
  add_decisions(result.limits, result.checks, json);
  if (result.against) json["against"] = against_json(*result.against);
  if (result.earlier) json["baseline"] = baseline_json(*result.earlier);
  if (result.population) json["population"] = yield_json(*result.population);
  if (result.seeds) json["seeds"] = seeds_json(*result.seeds);
  if (result.sigma) json["sigma"] = sigma_json(*result.sigma);
  json["warnings"] = result.warnings;
  json["provenance"] = provenance_json(result.provenance);
  return json;
}

}  // namespace beamgyro::internal
