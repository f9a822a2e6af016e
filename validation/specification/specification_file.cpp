// SPDX-License-Identifier: MIT
#include "validation/specification/specification_file.h"

#include <fmt/core.h>

#include <algorithm>

#include "config/document.h"
#include "config/suggestion.h"
#include "validation/specification/own_metrics.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void fail_unknown(const ConfigTable& limits,
                               const std::string& name) {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) names.emplace_back(metric.name);
  const std::string near = suggestion(name, names);
  limits.fail(
      name,
      near.empty()
          ? std::string("not a metric; the table of validate names all of them")
          : fmt::format("not a metric; did you mean '{}'?", near));
}

Limit limit_of(const ConfigTable& limits, const std::string& metric,
               const std::string& relative_to) {
  const ConfigTable table = limits.table(metric);
  Limit limit{.metric = metric,
              .relative_to = relative_to,
              .place = limits.position(metric)};
  limit.least = table.optional_number("min");
  limit.most = table.optional_number("max");
  limit.absolute = table.flag_or("absolute", false);
  limit.source = table.text("source");
  if (!limit.least && !limit.most)
    limits.fail(metric, "no limit; must have max, min or both");
  if (limit.least && limit.most && *limit.least > *limit.most)
    table.fail("min", fmt::format("{} is above max = {}, must be at most that",
                                  *limit.least, *limit.most));
  if (limit.source.empty())
    table.fail("source", "empty, must say where the number comes from");
  return limit;
}

constexpr const char* kOwn = "own";  // the table of the user's own metrics

// Which metrics of their own there are is not known yet.
void add_own_limits(const ConfigTable& limits, const std::string& relative_to,
                    std::vector<Limit>& all) {
  if (!relative_to.empty() && relative_to != "before")
    limits.fail(kOwn,
                fmt::format("metrics of your own have no value of the {}; "
                            "expected limits.own or "
                            "limits_relative_to.before.own",
                            relative_to));
  const ConfigTable own = limits.table(kOwn);
  for (const std::string& metric : own.keys()) {
    require_own_name(own.position(metric), metric, "1");
    all.push_back(limit_of(own, metric, relative_to));
    all.back().is_own = true;
  }
}

void add_limits(const ConfigTable& limits, const std::string& relative_to,
                std::vector<Limit>& all) {
  for (const std::string& metric : limits.keys()) {
    if (metric == kOwn) {
      add_own_limits(limits, relative_to, all);
      continue;
    }
    if (find_metric(metric) == nullptr) fail_unknown(limits, metric);
    all.push_back(limit_of(limits, metric, relative_to));
  }
}

constexpr const char* kDoesNotDecide = "does not decide";

std::vector<std::string> better_than(const ConfigTable& root) {
  if (!root.has("better_than")) return {};
  std::vector<std::string> names = root.texts("better_than");
  for (const std::string& name : names)
    if (name != "before" && name != "constant")
      root.fail(
          "better_than",
          fmt::format("'{}', must be of \"before\" and \"constant\"", name));
  return names;
}

DeclaredResponse declared_response(const ConfigTable& root) {
  const ConfigTable table = root.table_or_empty("declared");
  DeclaredResponse declared;
  // Slower answers would leave nothing to judge by rates held for seconds.
  declared.bandwidth = table.optional_number("bandwidth_Hz", {1.0, 1e5});
  declared.delay = table.number_or("delay_s", 0.0, {0.0, 0.5});
  declared.ready_after = table.number_or("ready_after_s", 0.0, {0.0, 60.0});
  declared.zeroes_at_power_on =
      table.number_or("zeroes_at_power_on_s", 0.0, {0.0, 60.0});
  declared.resolution =
      table.number_or("resolution_deg_per_s", 0.0, {0.0, 1.0});
  return declared;
}

SpecificationFile specification_of(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  SpecificationFile file;
  file.name = root.text("name");
  file.description = root.text_or("description", "");
  file.false_accept_risk = root.number_or("false_accept_risk", kFalseAcceptRisk,
                                          {0.0, 0.5, true, false});
  add_limits(root.table_or_empty("limits"), "", file.limits);
  const ConfigTable relative = root.table_or_empty("limits_relative_to");
  for (const char* reference :
       {"before", "constant", "cubic", "spline", "straight_lines"})
    add_limits(relative.table_or_empty(reference), reference, file.limits);
  file.better_than = better_than(root);
  file.may_leave_untested =
      root.choice_or("not_tested", "is undecided",
                     {"is undecided", kDoesNotDecide}) == kDoesNotDecide;
  file.declared = declared_response(root);
  document.reject_unknown_keys();
  if (file.limits.empty() && file.better_than.empty())
    root.fail("limits", "empty, must limit one metric or more");
  file.text = document.text();
  return file;
}

}  // namespace

SpecificationFile read_specification_file(const std::filesystem::path& file) {
  return specification_of(ConfigDocument::read(file));
}

SpecificationFile parse_specification_file(std::string_view text,
                                           const std::string& name) {
  return specification_of(ConfigDocument::parse(text, name));
}

const SpecificationFile& default_specification() {
  static const SpecificationFile kDefault = parse_specification_file(
#include "validation/specification/default_text.h"
      , "specs/default.toml");
  return kDefault;
}

}  // namespace beamgyro::internal
