// SPDX-License-Identifier: MIT
#include "validation/specification/own_metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "config/suggestion.h"
#include "dataset/log/log_text.h"
#include "validation/checks/checks.h"
#include "validation/metrics/metric.h"

namespace beamgyro::internal {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLongestName = 64, kLongestUnit = 32;
constexpr const char* kColumns = "name,unit,before,after[,low,high]";

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_own_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName &&
         is_letter(name.front()) && std::ranges::all_of(name, [](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
         });
}

// The number in a cell; nothing where it is empty.
std::optional<double> optional_number_in(const LogText& row, std::size_t slot) {
  std::string_view cell = row.cell(slot);
  if (cell.empty()) return std::nullopt;
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  const char* const end = cell.data() + cell.size();
  double number = 0.0;
  const auto [stop, error] = std::from_chars(cell.data(), end, number);
  if (error == std::errc::result_out_of_range)
    row.fail(slot, fmt::format("{}: out of range; expected a number",
                               shown_cell(row.cell(slot))));
  if (error != std::errc{} || stop != end)
    row.fail(slot, fmt::format("{}: not a number; expected one, or nothing",
                               shown_cell(row.cell(slot))));
  return number;
}

std::optional<double> bound_in(const LogText& row, std::size_t slot) {
  const std::optional<double> bound = optional_number_in(row, slot);
  if (bound && !std::isfinite(*bound))
    row.fail(slot, fmt::format("{}: no limit; expected a finite number, or "
                               "nothing",
                               shown_cell(row.cell(slot))));
  return bound;
}

void require_columns(const LogText& text, const std::filesystem::path& path) {
  std::vector<std::string> expected{"name", "unit", "before", "after"};
  if (text.names() == expected) return;
  expected.insert(expected.end(), {"low", "high"});
  if (text.names() == expected) return;
  throw std::invalid_argument(fmt::format(
      "{}:1:1: columns {}; expected {}", path.string(),
      shown_cell(fmt::format("{}", fmt::join(text.names(), ","))), kColumns));
}

// Adds the metric of a row, whose cells are slots in the order of kColumns, and
// its limit.
void add_row(const LogText& row, const std::filesystem::path& path,
             OwnMetricTable& table) {
  if (!row.is_whole())
    row.fail_row(
        fmt::format("{} cells; expected {}", row.cells(), row.names().size()));
  const std::string name(row.cell(0));
  const std::string unit(row.cell(1).empty() ? "1" : row.cell(1));
  const std::string place = fmt::format("{}:{}:1", path.string(), row.line());
  require_own_name(place, name, unit);
  if (std::ranges::count(table.metrics, name, &OwnMetricSource::name) > 0)
    row.fail(
        0, fmt::format("{}: stands there twice; expected one row of it", name));
  const double before = optional_number_in(row, 2).value_or(kNoValue);
  const double after = optional_number_in(row, 3).value_or(kNoValue);
  table.metrics.push_back(
      {name, unit, [before, after](const Evidence&, JudgedRate rate) {
         return rate == JudgedRate::kRecorded ? before : after;
       }});
  if (row.names().size() == 4) return;
  Limit limit{.metric = name,
              .least = bound_in(row, 4),
              .most = bound_in(row, 5),
              .source = path.filename().string(),
              .place = place,
              .is_own = true};
  if (limit.least && limit.most && *limit.least > *limit.most)
    row.fail(4, fmt::format("{} is above high = {}; expected at most that",
                            *limit.least, *limit.most));
  if (limit.least || limit.most) table.limits.push_back(std::move(limit));
}

}  // namespace

OwnMetricTable parse_own_metrics(std::string_view text,
                                 const std::filesystem::path& path) {
  if (text.empty())
    throw std::invalid_argument(fmt::format(
        "{}:1:1: is empty; expected columns {}", path.string(), kColumns));
  LogLayout layout;
  layout.delimiter = ',';
  LogText rows(text, path, layout);
  require_columns(rows, path);
  for (std::size_t k = 0; k < rows.names().size(); ++k) rows.select(k);
  OwnMetricTable table;
  while (rows.next()) add_row(rows, path, table);
  if (table.metrics.empty())
    throw std::invalid_argument(
        fmt::format("{}: has no row; expected a metric", path.string()));
  return table;
}

void require_own_name(const std::string& place, const std::string& name,
                      const std::string& unit) {
  if (!is_own_name(name))
    throw std::invalid_argument(fmt::format(
        "{}: {}: no name of a metric; expected a letter, then letters, digits "
        "and _, at most {} together",
        place, shown_cell(name), kLongestName));
  const bool is_check =
      std::ranges::count(check_definitions(), std::string_view(name),
                         &CheckDefinition::name) > 0;
  if (is_check || find_metric(name) != nullptr)
    throw std::invalid_argument(
        fmt::format("{}: {}: is the name of a {} of the program; expected "
                    "another one",
                    place, name, is_check ? "check" : "metric"));
  if (unit.empty() || unit.size() > kLongestUnit ||
      !std::ranges::all_of(unit, [](char c) { return c >= ' ' && c <= '~'; }))
    throw std::invalid_argument(fmt::format(
        "{}: {}: unit {}; expected 1 to {} printable characters of ASCII, such "
        "as deg/s",
        place, name, shown_cell(unit), kLongestUnit));
}

void require_own_metrics(std::span<const Limit> limits,
                         std::span<const OwnMetricSource> metrics) {
  std::vector<std::string> names;
  for (const OwnMetricSource& metric : metrics) names.push_back(metric.name);
  for (const Limit& limit : limits) {
    if (!limit.is_own || std::ranges::count(names, limit.metric) > 0) continue;
    const std::string near = suggestion(limit.metric, names);
    throw std::invalid_argument(fmt::format(
        "{}: {}: no metric of your own has this name; {}", limit.place,
        limit.metric,
        near.empty()
            ? fmt::format("expected {}",
                          names.empty() ? "one to be given"
                                        : fmt::format("one of {}",
                                                      fmt::join(names, ", ")))
            : fmt::format("did you mean '{}'?", near)));
  }
}

std::vector<OwnMetricResult> own_metric_results(
    std::span<const OwnMetricSource> metrics, const Evidence& before,
    const Evidence& after) {
  std::vector<OwnMetricResult> results;
  for (const OwnMetricSource& metric : metrics)
    results.push_back({metric.name,
                       metric.unit,
                       {metric.value(before, JudgedRate::kRecorded)},
                       {metric.value(after, JudgedRate::kCompensated)}});
  return results;
}

}  // namespace beamgyro::internal
