// SPDX-License-Identifier: MIT
#include "report/difference_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "validation/result/metric_change.h"

namespace beamgyro::internal {
namespace {

std::string interval_words(const std::optional<Interval>& interval) {
  return interval
             ? fmt::format("[{:.3g}, {:.3g}]", interval->low, interval->high)
             : "no interval";
}

// One that has no interval is told, too: a reader has to judge it.
bool is_listed(const MetricChange& one, bool all) {
  return all || one.change != Change::kSame;
}

std::string change_table(const std::vector<MetricChange>& changes,
                         std::string_view own, std::string_view other,
                         bool all) {
  std::size_t width = 6;
  for (const MetricChange& one : changes)
    if (is_listed(one, all)) width = std::max(width, one.metric->name.size());
  std::string text;
  for (const MetricChange& one : changes) {
    if (!is_listed(one, all)) continue;
    if (text.empty())
      text = fmt::format("  {:<8}{:<{}}{:>11}{:>11}{:>11}  95 % interval\n", "",
                         "metric", width, own, other, "difference");
    text += fmt::format("  {:<8}{:<{}}{:>11.3g}{:>11.3g}{:>11.3g}  {}\n",
                        change_name(one.change), one.metric->name, width,
                        one.own.value, one.other.value, one.difference.value,
                        interval_words(one.difference.interval));
  }
  return text;
}

std::string counts_of(const std::vector<MetricChange>& changes) {
  std::vector<std::string> parts;
  for (const Change change : {Change::kBetter, Change::kSame, Change::kWorse}) {
    const auto count =
        std::ranges::count(changes, change, &MetricChange::change);
    parts.push_back(fmt::format("{} {}", count, change_name(change)));
  }
  const auto open =
      std::ranges::count(changes, Change::kUnknown, &MetricChange::change);
  if (open > 0)
    parts.push_back(fmt::format("{} other without an interval", open));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string side_by_side_report(const SideBySide& other, bool all) {
  return fmt::format("metrics beside {}: {}\n{}", other.compensator.name,
                     counts_of(other.metrics),
                     change_table(other.metrics, "this", "other", all));
}

std::string earlier_report(const EarlierComparison& earlier, bool all) {
  std::string text =
      fmt::format("metrics beside {} (verdict {}): {}\n{}", earlier.name,
                  earlier.verdict, counts_of(earlier.metrics),
                  change_table(earlier.metrics, "now", "earlier", all));
  for (const std::string& name : earlier.lost)
    text += fmt::format("  passed in {} and does not now: {}\n", earlier.name,
                        name);
  return text;
}

}  // namespace beamgyro::internal
