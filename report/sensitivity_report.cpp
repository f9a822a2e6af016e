// SPDX-License-Identifier: MIT
#include "report/sensitivity_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {
namespace {

// Below it the tolerances by themselves leave most of the variance unexplained.
constexpr double kInteractionsDominate = 0.5;

std::string studied_name(const MeritResult& result) {
  const char* name = figure_of_merit(result.merit).name;
  return result.of_logarithm ? fmt::format("ln {}", name) : name;
}

// Without the sign of what rounds to zero.
double unsigned_zero(double value, int digits) {
  return std::abs(value) < 0.5 * std::pow(10, -digits) ? 0.0 : value;
}

std::string index_text(double value, const std::optional<Interval>& interval) {
  return fmt::format("{:>6.3f} {:>13}", unsigned_zero(value, 3),
                     interval ? fmt::format("{:.2f} .. {:.2f}",
                                            unsigned_zero(interval->low, 2),
                                            unsigned_zero(interval->high, 2))
                              : "-");
}

std::string index_text(const IndexEstimate& index) {
  return index_text(index.value, Interval{index.low, index.high});
}

// So that a row has no more than 100 columns.
constexpr std::size_t kWidestKey = 34;

std::size_t key_width(const MeritResult& result) {
  std::size_t width = 9;
  for (const FactorResult& factor : result.factors)
    width = std::max(width, factor.key.size());
  return std::min(width, kWidestKey);
}

// A key that is longer than its column stands above its row.
std::string key_cell(const std::string& key, std::size_t width) {
  if (key.size() <= width) return fmt::format("{:<{}}", key, width);
  return fmt::format("{}\n{:<{}}", key, "", width);
}

// The bootstrap intervals of the first orders, as if independent, tell how well
// their sum is known.
double uncertainty_of_sum(const MeritResult& result) {
  double squares = 0.0;
  for (const FactorResult& factor : result.factors)
    squares += std::pow(0.5 * (factor.first.high - factor.first.low), 2);
  return std::sqrt(squares);
}

std::string words_of_interactions(const MeritResult& result) {
  const double share = 1 - result.sum_of_first;
  const double half = uncertainty_of_sum(result);
  const double low = std::clamp(share - half, 0.0, 1.0);
  const double high = std::clamp(share + half, 0.0, 1.0);
  if (low == 0.0)
    return fmt::format("interactions at most {:.0f} %", 100 * high);
  return fmt::format("interactions {:.0f} % ({:.0f} to {:.0f} %)", 100 * share,
                     100 * low, 100 * high);
}

std::string words_of_sum(const MeritResult& result) {
  if (result.variance == 0)
    return "No tolerance of the campaign changes this figure.\n";
  std::string text =
      fmt::format("Sum of the first orders: {:.2f}. ", result.sum_of_first);
  if (result.sum_of_first < kInteractionsDominate)
    return text +
           fmt::format(
               "Interactions dominate: {:.0f} % of the variance comes from two "
               "or more\ntolerances together, so a tolerance with a large "
               "total "
               "index matters mostly by what\nit does to the effect of the "
               "others.\n",
               100 * (1 - std::max(result.sum_of_first, 0.0)));
  return text + fmt::format(
                    "The tolerances by themselves explain most of the "
                    "variance,\n{}.\n",
                    words_of_interactions(result));
}

// Tolerances with a share that they have with others for the most part.
std::string words_of_partners(const MeritResult& result) {
  constexpr double kCounts = 0.05, kMostly = 0.5;  // [-]
  std::vector<std::string> keys;
  for (const FactorResult& factor : result.factors)
    if (factor.total.low >= kCounts &&
        factor.first.high < kMostly * factor.total.value)
      keys.push_back(factor.key);
  if (keys.empty()) return "";
  return fmt::format("Mostly together with others: {}.\n",
                     fmt::join(keys, ",\n  "));
}

std::string share_text(const DeviceShare& share) {
  return fmt::format("{:>6.1f} % {:>15}", 100 * share.value,
                     fmt::format("{:.1f} .. {:.1f}", 100 * share.interval.low,
                                 100 * share.interval.high));
}

std::string width_text(const std::optional<double>& width) {
  return width ? fmt::format("{:.2f}", *width)
               : fmt::format("under {:g}", kNarrowest);
}

std::string needed_table(const YieldResult& yield, std::size_t width) {
  if (!yield.target) return "";
  std::string text = fmt::format(
      "Width of one tolerance for a yield of {:g} %, of what it is:\n",
      100 * *yield.target);
  for (const NeededWidth& needed : yield.needed)
    fmt::format_to(std::back_inserter(text), "{} {:>10} {:>20}\n",
                   key_cell(needed.key, width), width_text(needed.width),
                   fmt::format("{} .. {}", width_text(needed.narrow),
                               width_text(needed.wide)));
  return text;
}

std::string yield_table(const MeritResult& result) {
  const YieldResult& yield = *result.yield;
  std::size_t width = 11;
  for (const HalvedYield& halved : yield.halved)
    width = std::max(width, std::min(halved.key.size() + 2, kWidestKey));
  const FigureOfMerit& figure = figure_of_merit(result.merit);
  std::string text =
      fmt::format("Share of devices within {} = {:g}:\n{:<{}} {:>8} {:>15}\n",
                  figure.name, yield.limit, "", width, "yield", "95 %");
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{:<{}} {}\n", "as they are", width,
                 share_text(yield.as_is));
  for (const HalvedYield& halved : yield.halved)
    fmt::format_to(
        out, "{} {}\n", key_cell(halved.key + "/2", width),
        halved.share ? share_text(*halved.share) : fmt::format("{:>8}", "-"));
  if (!yield.pairs.empty()) text += "Two of them at once:\n";
  for (const PairYield& pair : yield.pairs)
    fmt::format_to(
        out, "{} {}\n",
        key_cell(fmt::format("{}/2, {}/2", pair.first, pair.second), width),
        share_text(pair.share));
  return text + needed_table(yield, width);
}

nlohmann::ordered_json interval_json(const IndexEstimate& index) {
  return {index.low, index.high};
}

nlohmann::ordered_json yield_json(const YieldResult& yield) {
  nlohmann::ordered_json halved = nlohmann::ordered_json::array();
  for (const HalvedYield& each : yield.halved) {
    nlohmann::ordered_json entry = {
        {"key", each.key}, {"yield", nullptr}, {"yield_interval", nullptr}};
    if (each.share) {
      entry["yield"] = each.share->value;
      entry["yield_interval"] = {each.share->interval.low,
                                 each.share->interval.high};
    }
    halved.push_back(entry);
  }
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
  for (const PairYield& pair : yield.pairs)
    pairs.push_back({{"keys", {pair.first, pair.second}},
                     {"yield", pair.share.value},
                     {"yield_interval",
                      {pair.share.interval.low, pair.share.interval.high}}});
  nlohmann::ordered_json needed = nlohmann::ordered_json::array();
  for (const NeededWidth& each : yield.needed)
    needed.push_back(
        {{"key", each.key},
         {"width", number(each.width)},
         {"width_interval", {number(each.narrow), number(each.wide)}}});
  return {
      {"limit", yield.limit},
      {"as_is", yield.as_is.value},
      {"as_is_interval", {yield.as_is.interval.low, yield.as_is.interval.high}},
      {"halved", halved},
      {"pairs", pairs},
      {"target", number(yield.target)},
      {"needed", needed}};
}

nlohmann::ordered_json merit_json(const MeritResult& result) {
  nlohmann::ordered_json indices = nlohmann::ordered_json::array();
  for (const FactorResult& factor : result.factors) {
    indices.push_back({{"key", factor.key},
                       {"first", factor.first.value},
                       {"first_interval", interval_json(factor.first)},
                       {"total", factor.total.value},
                       {"total_interval", interval_json(factor.total)},
                       {"first_by_rank", factor.first_by_rank.value},
                       {"first_by_rank_interval", nullptr},
                       {"total_by_product", factor.total_by_product},
                       {"rows", factor.rows}});
    if (const auto& interval = factor.first_by_rank.interval)
      indices.back()["first_by_rank_interval"] = {interval->low,
                                                  interval->high};
  }
  const FigureOfMerit& figure = figure_of_merit(result.merit);
  return {{"of", studied_name(result)},
          {"unit", figure.unit},
          {"meaning", figure.what},
          {"samples", result.samples},
          {"rows", result.rows},
          {"p05", result.quantiles[0]},
          {"median", result.quantiles[1]},
          {"p95", result.quantiles[2]},
          {"variance", result.variance},
          {"sum_of_first", result.sum_of_first},
          {"indices", indices},
          {"yield", result.yield ? yield_json(*result.yield)
                                 : nlohmann::ordered_json()}};
}

}  // namespace

std::string sample_lines(const DeviceSample& sample, const StudyHead& head) {
  std::string text = fmt::format(
      "{}: {} samples of {} tolerances, {} devices, {:g} to {:g} degC, seed "
      "{}\n",
      head.campaign,
      sample.merits.empty() ? 0 : sample.merits[0].design.a.size(),
      sample.factors.size(), sample.devices, head.grid.low, head.grid.high,
      head.seed);
  if (sample.failures == 0) return text + "Every device was computed.\n";
  return text + fmt::format(
                    "{} devices ({:.3g} %) do not work; indices leave their "
                    "rows out, a yield counts them as bad.\nThe first of them: "
                    "{}\n",
                    sample.failures,
                    100.0 * static_cast<double>(sample.failures) /
                        static_cast<double>(sample.devices),
                    sample.first_failure);
}

std::string sensitivity_table(const MeritResult& result) {
  const FigureOfMerit& figure = figure_of_merit(result.merit);
  const std::size_t width = key_width(result);
  std::string text = fmt::format(
      "{}: {}\nmedian {:.4g}, 5 to 95 % of devices {:.4g} to {:.4g}{}\n"
      "{:<{}} {:>6} {:>13} {:>6} {:>13} {:>6} {:>13}\n",
      studied_name(result), figure.what, result.quantiles[1],
      result.quantiles[0], result.quantiles[2],
      figure.unit == std::string_view("1") ? ""
                                           : fmt::format(" {}", figure.unit),
      "tolerance", width, "total", "95 %", "first", "95 %", "ranks", "95 %");
  for (const FactorResult& factor : result.factors)
    text += fmt::format(
        "{} {} {} {}\n", key_cell(factor.key, width), index_text(factor.total),
        index_text(factor.first),
        index_text(factor.first_by_rank.value, factor.first_by_rank.interval));
  text += words_of_sum(result) + words_of_partners(result);
  if (result.rows < result.samples)
    text +=
        fmt::format("{} of {} samples count.\n", result.rows, result.samples);
  if (result.yield) text += yield_table(result);
  return text;
}

nlohmann::ordered_json to_json(const DeviceSample& sample,
                               const StudyHead& head,
                               const std::vector<MeritResult>& results) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::object();
  for (const MeritResult& result : results)
    figures[figure_of_merit(result.merit).name] = merit_json(result);
  nlohmann::ordered_json json = {
      {"campaign", head.campaign},
      {"seed", head.seed},
      {"range_degC", {head.grid.low, head.grid.high}},
      {"temperatures", head.grid.count},
      {"devices", sample.devices},
      {"failures", sample.failures},
      {"first_failure", nullptr},
      {"figures", figures}};
  if (sample.failures > 0) json["first_failure"] = sample.first_failure;
  return json;
}

}  // namespace beamgyro::internal
