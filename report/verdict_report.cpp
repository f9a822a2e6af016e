// SPDX-License-Identifier: MIT
#include "report/verdict_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "report/difference_report.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kReportWidth = 100;

std::string figure(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

std::string figure(const std::optional<Estimate>& estimate) {
  return estimate ? fmt::format("{:.3g}", estimate->value) : "-";
}

// Breaks a text between words. Later lines are indented.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string lines, line;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.size() + 1 + word.size() > kReportWidth) {
      lines += line + '\n';
      line = std::string(indent, ' ');
    } else if (!line.empty()) {
      line += ' ';
    }
    line += word;
  }
  return lines + line + '\n';
}

// Names of the baselines beside "none", which is the recorded rate.
std::vector<std::string> baseline_names(const ValidationResult& result) {
  std::vector<std::string> names;
  if (result.metrics.empty()) return names;
  for (const BaselineEstimate& baseline : result.metrics[0].baselines)
    if (baseline.name != "none") names.push_back(baseline.name);
  return names;
}

std::size_t column_width(const std::string& name) {
  return std::max(name.size() + 2, std::size_t{10});
}

// Whether a metric stands in the short table.
bool decides(const ValidationResult& result, const MetricResult& metric) {
  if (metric.metric->name == "residual_rms_deg_per_s") return true;
  return std::ranges::any_of(result.limits, [&](const DecidedLimit& decided) {
    return decided.limit.metric == metric.metric->name;
  });
}

std::string metric_table(const ValidationResult& result, bool all) {
  const std::vector<std::string> names = baseline_names(result);
  std::size_t width = 6;
  for (const MetricResult& metric : result.metrics)
    if (all || decides(result, metric))
      width = std::max(width, metric.metric->name.size());
  std::string text =
      fmt::format("{:<{}}{:>10}{:>10}", "metric", width, "before", "after");
  for (const std::string& name : names)
    text += fmt::format("{:>{}}", name, column_width(name));
  text += '\n';
  for (const MetricResult& metric : result.metrics) {
    if (!metric.before && !metric.after) continue;
    if (!all && !decides(result, metric)) continue;
    text += fmt::format("{:<{}}{:>10}{:>10}", metric.metric->name, width,
                        figure(metric.before), figure(metric.after));
    for (const BaselineEstimate& baseline : metric.baselines)
      if (baseline.name != "none")
        text += fmt::format("{:>{}}", figure(baseline.estimate),
                            column_width(baseline.name));
    text += '\n';
  }
  return text;
}

// Metrics of the user's own, in full; without any it is empty.
std::string own_metric_table(const ValidationResult& result) {
  if (result.own_metrics.empty()) return "";
  std::size_t width = 10;
  for (const OwnMetricResult& metric : result.own_metrics)
    width = std::max(width, metric.name.size());
  std::string text = fmt::format("\n{:<{}}{:>10}{:>10}  unit\n", "own metric",
                                 width, "before", "after");
  for (const OwnMetricResult& metric : result.own_metrics)
    text += fmt::format("{:<{}}{:>10.3g}{:>10.3g}  {}\n", metric.name, width,
                        metric.before.value, metric.after.value, metric.unit);
  return text;
}

std::string purposes_of(const Metric& metric, const char* separator) {
  std::vector<std::string_view> purposes;
  for (const RunPurpose purpose : metric.reads)
    purposes.push_back(purpose_name(purpose));
  return fmt::format("{}", fmt::join(purposes, separator));
}

// Why a limit could not be decided on.
std::string why_without_value(const ValidationResult& result,
                              const Limit& limit) {
  if (limit.is_own) return "no finite value";
  const auto found = std::ranges::find_if(result.metrics, [&](const auto& one) {
    return one.metric->name == limit.metric;
  });
  const Metric* metric = find_metric(limit.metric);
  if (metric != nullptr && metric->is_of_sigma && !result.sigma)
    return "the compensator states no sigma";
  if (found == result.metrics.end() || found->after) return "no number";
  const bool has_run =
      std::ranges::any_of(found->metric->reads, [&](RunPurpose purpose) {
        return std::ranges::count(result.runs, purpose_name(purpose),
                                  &RunResidual::purpose) > 0;
      });
  return (has_run ? "too small or too slow to be seen in the runs for "
                  : "not shown by a run for ") +
         purposes_of(*found->metric, ", ");
}

std::string limit_line(const ValidationResult& result,
                       const DecidedLimit& decided) {
  const auto& [limit, decision] = decided;
  std::string value = figure(decision.compared);
  if (decision.compared && decision.compared->interval)
    value += fmt::format(" [{:.3g}, {:.3g}]", decision.compared->interval->low,
                         decision.compared->interval->high);
  if (limit.is_own) value += " (no interval)";
  if (!decision.compared)
    return wrapped(
        fmt::format("{:<10}{}: {}, {}", verdict_name(decision.result),
                    limit.metric, why_without_value(result, limit),
                    text_of(limit)),
        10);
  return wrapped(
      fmt::format("{:<10}{}: {}, {}, margin {}{}{}",
                  verdict_name(decision.result), limit.metric, value,
                  text_of(limit), figure(decision.margin),
                  decision.met_before ? "; met before compensation" : "",
                  decision.too_noisy
                      ? "; the noise of these runs hides a figure as small as "
                        "the limit"
                      : ""),
      10);
}

std::string check_line(const CheckResult& check) {
  const char* outcome = check.outcome == CheckOutcome::kPassed   ? "passed"
                        : check.outcome == CheckOutcome::kFailed ? "FAILED"
                                                                 : "not tested";
  std::string text =
      fmt::format("{:<11}{}: {}", outcome, check.name, check.words);
  std::ranges::replace(text, '\n', ' ');
  return wrapped(text, 11);
}

std::string check_lines(const ValidationResult& result, bool all) {
  std::string text;
  std::vector<std::string> passed;
  for (const CheckResult& check : result.checks)
    if (all || !check.passed())
      text += check_line(check);
    else
      passed.push_back(check.name);
  if (passed.empty()) return text;
  return wrapped(fmt::format("{:<11}{}", "passed", fmt::join(passed, ", ")),
                 11) +
         text;
}

std::string run_table(const ValidationResult& result) {
  std::size_t width = 3;
  for (const RunResidual& run : result.runs)
    width = std::max(width, run.name.size());
  std::string text = fmt::format("{:<{}}  {:<14}{:>10}{:>10}  deg/s rms\n",
                                 "run", width, "purpose", "before", "after");
  for (const RunResidual& run : result.runs)
    text += fmt::format("{:<{}}  {:<14}{:>10.3g}{:>10.3g}\n", run.name, width,
                        run.purpose, run.before, run.after);
  return text;
}

// Median and worst of a figure over devices; one that is missing is the worst.
std::string median_and_worst(std::vector<double> values) {
  for (double& value : values)
    value = std::isnan(value) ? HUGE_VAL : std::abs(value);
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return fmt::format("{:>10.3g}{:>10.3g}",
                     0.5 * (values[(n - 1) / 2] + values[n / 2]),
                     values[n - 1]);
}

// Metrics over devices or seeds: "20 seeds".
std::string followed_table(const std::string& number,
                           const std::vector<PopulationMetric>& metrics) {
  if (metrics.empty()) return "";
  std::size_t width = 7;
  for (const PopulationMetric& metric : metrics)
    width = std::max(width, metric.metric->name.size());
  std::string text = fmt::format(
      "{:<{}}{:>20}{:>20}\n{:{}}{:>10}{:>10}{:>10}{:>10}\n", number, width,
      "before", "after", "", width, "median", "worst", "median", "worst");
  for (const PopulationMetric& metric : metrics)
    text += fmt::format("{:<{}}{}{}\n", metric.metric->name, width,
                        median_and_worst(metric.before),
                        median_and_worst(metric.after));
  return text;
}

std::string yield_lines(const PopulationYield& population) {
  return wrapped(
      fmt::format(
          "yield of {}: {} of {} devices pass every limit, {:.1f} % [{:.1f}, "
          "{:.1f}]; {} fail, {} undecided; {}",
          population.campaign, population.passed, population.devices.size(),
          100 * population.share(), 100 * population.interval.low,
          100 * population.interval.high, population.failed,
          population.undecided,
          population.trained_on_each ? "trained on each device"
                                     : "one compensator for all"),
      2);
}

std::string seed_lines(const SeedVerdicts& seeds) {
  std::string text = wrapped(
      fmt::format("{} of {} seeds from {} on pass, {:.1f} % [{:.1f}, {:.1f}]; "
                  "{} fail, {} undecided; all above is of the seed {}",
                  seeds.passed, seeds.seeds.size(), seeds.seeds.front().seed,
                  100 * seeds.share(), 100 * seeds.interval.low,
                  100 * seeds.interval.high, seeds.failed, seeds.undecided,
                  seeds.shown),
      2);
  for (const auto& [seed, verdict, words] : seeds.seeds)
    if (verdict != Verdict::kPass)
      text += wrapped(
          fmt::format("{:<10}seed {}: {}", verdict_name(verdict), seed, words),
          10);
  return text;
}

// "91.2 % [85, 95] of 27 soaks", of the intervals of 90 %.
std::string coverage_words(const SigmaFit& fit, const char* groups) {
  constexpr std::size_t kNinety = 1;
  const auto& seen = fit.coverage.at(kNinety);
  if (!seen) return fmt::format("no {}", groups);
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}] of {} {}", 100 * seen->value,
                     100 * seen->interval->low, 100 * seen->interval->high,
                     fit.groups, groups);
}

std::string sigma_lines(const SigmaReport& sigma) {
  std::string text =
      fmt::format("sigma: its 90 % interval holds {} and {}",
                  coverage_words(sigma.soaks, "soaks"),
                  coverage_words(sigma.ramps, "stretches of ramps"));
  if (sigma.nis)
    text += fmt::format(
        "; a bias filter that believes it has a mean normalised innovation "
        "squared of {:.3g} [{:.3g}, {:.3g}] over {} update{}",
        sigma.nis->value, sigma.nis->interval->low, sigma.nis->interval->high,
        sigma.updates, sigma.updates == 1 ? "" : "s");
  return wrapped(text, 2);
}

// "nominal.toml, qualification.toml", "device 7 of set", or "3 recordings".
std::string evidence_words(const ValidationResult& result) {
  const ResultProvenance& provenance = result.provenance;
  if (!provenance.device.empty())
    return provenance.device + ", " + provenance.qualification +
           (provenance.seed ? fmt::format(", seed {}", *provenance.seed) : "");
  if (result.population)
    return result.population->shown.empty()
               ? result.population->campaign
               : fmt::format("device {} of {}", result.population->shown,
                             result.population->campaign);
  const auto runs = std::ranges::count(provenance.files, std::string("runs"),
                                       &ResultFile::group);
  return fmt::format("{} recording{}", runs, runs == 1 ? "" : "s");
}

std::string workbench_line(const JudgedCompensator& compensator) {
  if (!compensator.workbench) return "";
  const WorkbenchDifference& found = *compensator.workbench;
  return wrapped(
      fmt::format("difference from {}: at most {:.2g} deg/s, rms {:.2g} deg/s "
                  "of {} answers",
                  found.name, found.largest, found.rms, found.samples),
      2);
}

// "isolation: isolated; it could read mine.py beside the system".
std::string isolation_line(const ValidationResult& result) {
  if (!result.isolation) return "";
  std::string text = "isolation: " + isolation_words(*result.isolation);
  std::vector<std::string> names;
  for (const AllowedFile& file : result.isolation->files)
    names.push_back(file.name);
  if (result.isolation->holds() && !names.empty())
    text += fmt::format("; it could read {} beside the system",
                        fmt::join(names, ", "));
  return wrapped(text, 2);
}

std::string last_lines(const ValidationResult& result) {
  std::string verdict(verdict_name(result.verdict));
  std::ranges::transform(verdict, verdict.begin(), [](char c) {
    return static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  });
  return wrapped(fmt::format("{}: {}", verdict, result.words), 2) +
         wrapped(fmt::format("next: {}", result.next), 2);
}

}  // namespace

std::string verdict_report(const ValidationResult& result, bool all) {
  std::string text =
      wrapped(
          fmt::format("{} on {}; specification {}", result.compensator.name,
                      evidence_words(result), result.provenance.specification),
          2) +
      workbench_line(result.compensator) + isolation_line(result) + '\n' +
      run_table(result) + '\n' + metric_table(result, all) +
      own_metric_table(result);
  if (result.population)
    text +=
        '\n' + followed_table(
                   fmt::format("{} devices", result.population->devices.size()),
                   result.population->metrics);
  if (result.seeds)
    text += '\n' +
            followed_table(fmt::format("{} seeds", result.seeds->seeds.size()),
                           result.seeds->metrics);
  if (!result.limits.empty()) text += '\n';
  for (const DecidedLimit& limit : result.limits)
    text += limit_line(result, limit);
  text += '\n' + check_lines(result, all);
  if (result.sigma) text += '\n' + sigma_lines(*result.sigma);
  if (result.population) text += '\n' + yield_lines(*result.population);
  if (result.against)
    text += '\n' + wrapped(result.against->sentence, 2) +
            wrapped(fmt::format("{}: {}: {}", result.against->compensator.name,
                                verdict_name(result.against->verdict),
                                result.against->words),
                    2) +
            side_by_side_report(*result.against, all);
  if (result.earlier) text += '\n' + earlier_report(*result.earlier, all);
  if (result.seeds) text += '\n' + seed_lines(*result.seeds);
  return text + '\n' + last_lines(result);
}

std::string metric_list() {
  std::string lines;
  for (const Metric& metric : metrics()) {
    lines +=
        fmt::format("{}\t{}\t{}\t{}\t{}\n", metric.name, metric.unit,
                    metric.clause, purposes_of(metric, " "), metric.definition);
  }
  return lines;
}

}  // namespace beamgyro::internal
