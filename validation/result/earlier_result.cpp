// SPDX-License-Identifier: MIT
#include "validation/result/earlier_result.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "dataset/files/json_node.h"
#include "validation/result/metric_change.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kMostNamed = 3;  // metrics, in the words of a verdict

std::string limit_name(const std::string& metric,
                       const std::string& relative_to) {
  return relative_to.empty()
             ? metric
             : fmt::format("{} relative to {}", metric, relative_to);
}

std::optional<Estimate> estimate_in(const JsonNode& node) {
  if (node.is_null()) return std::nullopt;
  const std::optional<double> value = node.at("value").optional_number();
  if (!value) return std::nullopt;
  Estimate estimate{*value};
  const JsonNode interval = node.at("interval");
  if (interval.is_null()) return estimate;
  const std::vector<JsonNode> ends = interval.elements();
  if (ends.size() != 2) interval.fail("expected two ends");
  const auto low = ends[0].optional_number(), high = ends[1].optional_number();
  if (low && high) estimate.interval = {*low, *high};
  return estimate;
}

// Groups of files of which one result has others than the other one.
std::vector<std::string> groups_that_differ(
    const std::vector<ResultFile>& some,
    const std::vector<ResultFile>& others) {
  std::map<std::string, std::multiset<std::string>> before, now;
  for (const ResultFile& file : some) before[file.group].insert(file.sha256);
  for (const ResultFile& file : others) now[file.group].insert(file.sha256);
  std::vector<std::string> groups;
  for (const char* group : {"device", "qualification", "runs", "specification"})
    if (before[group] != now[group]) groups.emplace_back(group);
  return groups;
}

std::string estimate_words(const Estimate& estimate) {
  if (!estimate.interval) return fmt::format("{:.3g}", estimate.value);
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", estimate.value,
                     estimate.interval->low, estimate.interval->high);
}

// "Worse than old.json: ..."
std::string words_of_worse(const EarlierComparison& found) {
  std::vector<std::string> parts;
  std::size_t more = 0;
  for (const MetricChange& one : found.metrics) {
    if (one.change != Change::kWorse) continue;
    if (parts.size() < kMostNamed)
      parts.push_back(fmt::format("{} is {}, was {}", one.metric->name,
                                  estimate_words(one.own),
                                  estimate_words(one.other)));
    else
      ++more;
  }
  if (more > 0)
    parts.push_back(
        fmt::format("{} more metric{}", more, more == 1 ? "" : "s"));
  if (!found.lost.empty())
    parts.push_back(
        fmt::format("no longer passed: {}", fmt::join(found.lost, ", ")));
  return fmt::format("Worse than {}: {}.", found.name, fmt::join(parts, "; "));
}

}  // namespace

EarlierResult parse_earlier_result(const std::string& text,
                                   const std::string& path) {
  const nlohmann::ordered_json json = parse_json(text, path);
  const JsonNode node(json, path);
  const JsonNode filetype = node.at("filetype");
  if (filetype.text() != "beamgyro-validation")
    filetype.fail(fmt::format(
        "\"{}\"; expected \"beamgyro-validation\", the result of a validation",
        filetype.text()));
  EarlierResult earlier;
  earlier.name = std::filesystem::path(path).filename().string();
  earlier.verdict = node.at("verdict").text();
  for (const JsonNode& metric : node.at("metrics").elements())
    if (const auto estimate = estimate_in(metric.at("after")))
      earlier.metrics[metric.at("name").text()] = *estimate;
  for (const JsonNode& limit : node.at("limits").elements()) {
    const JsonNode reference = limit.at("relative_to");
    const std::string name = limit_name(
        limit.at("metric").text(), reference.is_null() ? "" : reference.text());
    const bool passed = limit.at("result").text() == "pass";
    const auto [place, is_new] = earlier.passed.emplace(name, passed);
    if (!is_new) place->second = place->second && passed;
  }
  const std::vector<JsonNode> checks = node.at("checks").elements();
  for (std::size_t k = 0; k < checks.size(); ++k)
    earlier.passed[checks[k].at("name").text()] =
        json["checks"][k].value("passed", nlohmann::ordered_json()) == true;
  for (const JsonNode& file : node.at("provenance").at("files").elements())
    earlier.files.push_back({file.at("group").text(), file.at("name").text(),
                             file.at("sha256").text()});
  if (earlier.metrics.empty() && earlier.passed.empty())
    node.fail(
        "has no metric, limit or check, so that nothing could be worse; "
        "expected the result of a validation");
  return earlier;
}

void compare_with(const EarlierResult& earlier, ValidationResult& result) {
  EarlierComparison found{earlier.name, earlier.verdict, {}, {}, {}};
  for (const MetricResult& metric : result.metrics) {
    const auto was = earlier.metrics.find(std::string(metric.metric->name));
    if (metric.after && was != earlier.metrics.end())
      found.metrics.push_back(
          change_of(*metric.metric, *metric.after, was->second));
  }
  const auto add_lost = [&](const std::string& name, bool passes) {
    const auto was = earlier.passed.find(name);
    if (!passes && was != earlier.passed.end() && was->second &&
        std::ranges::count(found.lost, name) == 0)
      found.lost.push_back(name);
  };
  for (const auto& [limit, decision] : result.limits)
    add_lost(limit_name(limit.metric, limit.relative_to),
             decision.result == Verdict::kPass);
  for (const CheckResult& check : result.checks)
    add_lost(check.name, check.passed());
  found.other_inputs =
      groups_that_differ(earlier.files, result.provenance.files);
  for (const std::string& group : found.other_inputs)
    result.warnings.push_back(fmt::format(
        "{}: its {} is not that of this result, which may cause a difference",
        earlier.name, group));
  if (found.is_worse()) {
    result.verdict = Verdict::kFail;
    result.words = words_of_worse(found) + " " + result.words;
    result.next = fmt::format(
        "find out what changed since {}, or keep this result in its place if "
        "the change is meant",
        earlier.name);
  } else {
    result.words += fmt::format(" Nothing is worse than in {}.", earlier.name);
  }
  result.earlier = std::move(found);
}

}  // namespace beamgyro::internal
