// SPDX-License-Identifier: MIT
#include "report/plan_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "planning/schedule_file.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

std::string temperatures_text(const SoakPlan& plan) {
  return fmt::format("{:g}", fmt::join(plan.temperatures, ", "));
}

std::string forecast_interval_text(
    const std::optional<ForecastIntervals>& intervals,
    Interval ForecastIntervals::*which) {
  if (!intervals) return fmt::format(" {:14}", "");
  const Interval& interval = *intervals.*which;
  return fmt::format(
      " {:<14}", fmt::format("[{:.3f}, {:.3f}]", interval.low, interval.high));
}

std::string interval_columns(const SoakPlan& plan) {
  const auto& [median, p90, p95, intervals] = plan.expected;
  return fmt::format(
      "{:>7.2f}{:>8.3f}{}{:>7.3f}{:>7.3f}{}", plan.hours, median,
      forecast_interval_text(intervals, &ForecastIntervals::median), p90, p95,
      forecast_interval_text(intervals, &ForecastIntervals::p95));
}

std::string forecast_columns(const SoakPlan& plan) {
  return fmt::format("{:>7.2f}{:>9.3f}{:>9.3f}{:>9.3f}", plan.hours,
                     plan.expected.median, plan.expected.p90,
                     plan.expected.p95);
}

std::string gain_lines(const PlanResult& result) {
  if (!result.gain)
    return "gain over straight lines between even soaks: not known without "
           "the devices of the population\n\n";
  const auto& [value, interval] = *result.gain;
  std::string_view what = "gain";
  if (interval.low > 1.0)
    what = "no gain, straight lines are better";
  else if (interval.high >= 1.0)
    what = "no gain";
  const std::size_t soaks = result.even.temperatures.size();
  return fmt::format(
      "{}: the plan leaves {:.2f} [{:.2f}, {:.2f}] of what {} leave\n"
      "(medians of {} devices, each predicted by the others, 95 %)\n\n",
      what, value, interval.low, interval.high,
      soaks == 1 ? "constants through one soak"
                 : fmt::format("straight lines between {} even soaks", soaks),
      result.devices_tried);
}

std::string schedule_lines(const PlanResult& result) {
  const SoakPlan& plan = result.chosen;
  std::string text = fmt::format(
      "{} in {:.2f} h for {:g} to {:g} degC, of {}; population of {} "
      "devices\n",
      soak_count(plan.temperatures.size()), plan.hours, result.range.lowest,
      result.range.highest, fmt::join(result.observed, " and "),
      result.devices);
  for (const Visit& visit : visits(plan.temperatures, result.time))
    fmt::format_to(std::back_inserter(text), "  {:>5} to {:>5}  {:g} degC\n",
                   clock_time(visit.begin), clock_time(visit.end),
                   visit.temperature);
  fmt::format_to(std::back_inserter(text),
                 "from {:g} degC at 0:00, ramps of {:g} K/min, soaks of {:g} "
                 "min\n"
                 "to be trained on with {}\n\n",
                 result.time.start, result.time.ramp, result.time.hold / 60.0,
                 rule_text(result.rule));
  return text;
}

std::string comparison(const PlanResult& result) {
  std::string text =
      fmt::format("{:<10}{:>7}{:>8} {:<14}{:>7}{:>7} {:<14}  rms left, deg/s\n",
                  "schedule", "hours", "median", "95 %", "p90", "p95", "95 %");
  const auto line = [&](const char* name, const SoakPlan& plan) {
    fmt::format_to(std::back_inserter(text), "{:<10}{}  {}\n", name,
                   interval_columns(plan), temperatures_text(plan));
  };
  line("planned", result.chosen);
  line("even", result.even);
  if (result.straight_lines)
    line("lines", {result.even.temperatures, result.even.hold,
                   result.even.hours, *result.straight_lines});
  for (const SoakPlan& plan : result.candidates) line("candidate", plan);
  return text;
}

std::string extrapolated_lines(const PlanResult& result) {
  std::string text;
  for (const auto& [range, expected] : result.extrapolated)
    fmt::format_to(
        std::back_inserter(text),
        "beyond the chamber, extrapolated from {:g} to {:g} degC: "
        "median {:.3f}{}, p95 {:.3f} deg/s\n",
        range.lowest, range.highest, expected.median,
        expected.intervals
            ? fmt::format(" [{:.3f}, {:.3f}]", expected.intervals->median.low,
                          expected.intervals->median.high)
            : "",
        expected.p95);
  return text;
}

std::string hysteresis_line(const PlanResult& result) {
  if (!result.hysteresis) return "";
  return fmt::format(
      "for a gyro that is warmed and cooled: hysteresis of +-{:.3f} deg/s rms "
      "is "
      "counted\n",
      *result.hysteresis);
}

std::string trade_off_table(const std::vector<TradeOff>& table) {
  std::string text = fmt::format(
      "\n{:<6}{:>10}{:>9}{:>9}{:>9}{:>8}{:>9}{:>9}{:>9}{:>14}{:>8}\n", "soaks",
      "planned: h", "median", "p90", "p95", "even: h", "median", "p90", "p95",
      "lines: median", "p95");
  for (const TradeOff& row : table)
    fmt::format_to(std::back_inserter(text), "{:<6}   {} {}{}\n",
                   row.planned.temperatures.size(),
                   forecast_columns(row.planned), forecast_columns(row.even),
                   row.straight_lines ? fmt::format("{:>14.3f}{:>8.3f}",
                                                    row.straight_lines->median,
                                                    row.straight_lines->p95)
                                      : fmt::format("{:>14}{:>8}", "-", "-"));
  return text;
}

Json forecast_json(const ResidualForecast& expected) {
  Json json = {{"median", expected.median}, {"p90", expected.p90},
               {"p95", expected.p95},       {"median_interval", nullptr},
               {"p90_interval", nullptr},   {"p95_interval", nullptr}};
  if (expected.intervals) {
    const auto& [median, p90, p95] = *expected.intervals;
    json["median_interval"] = {median.low, median.high};
    json["p90_interval"] = {p90.low, p90.high};
    json["p95_interval"] = {p95.low, p95.high};
  }
  return json;
}

Json soaks_json(const SoakPlan& plan) {
  return {{"temperatures_degC", plan.temperatures},
          {"hold_s", plan.hold},
          {"hours", plan.hours},
          {"expected_rms_deg_per_s", forecast_json(plan.expected)}};
}

Json optional_json(const std::optional<ResidualForecast>& expected) {
  return expected ? forecast_json(*expected) : Json();
}

Json gain_json(const PlanResult& result) {
  if (!result.gain) return {};
  const auto& [value, interval] = *result.gain;
  return {{"ratio", value},
          {"interval", {interval.low, interval.high}},
          {"devices", result.devices_tried}};
}

Json schedule_json(const PlanResult& result) {
  Json stops = Json::array();
  for (const Visit& visit : visits(result.chosen.temperatures, result.time))
    stops.push_back({{"temperature_degC", visit.temperature},
                     {"begin_s", visit.begin},
                     {"end_s", visit.end}});
  return {{"temperatures_degC", result.chosen.temperatures},
          {"hold_s", result.time.hold},
          {"ramp_K_per_min", result.time.ramp},
          {"hours", result.chosen.hours},
          {"start_degC", result.time.start},
          {"rows",
           {{"steady_K_per_min", result.rule.steady},
            {"lag_min", result.rule.lag},
            {"after_power_on_min", result.rule.after_power_on}}},
          {"visits", std::move(stops)}};
}

}  // namespace

std::string plan_text(const PlanResult& result) {
  return gain_lines(result) + schedule_lines(result) + comparison(result) +
         extrapolated_lines(result) + hysteresis_line(result) +
         trade_off_table(result.trade_offs);
}

Json plan_json(const PlanResult& result) {
  Json table = Json::array(), candidates = Json::array();
  Json extrapolated = Json::array();
  for (const auto& [range, expected] : result.extrapolated)
    extrapolated.push_back(
        {{"range_degC", {range.lowest, range.highest}},
         {"expected_rms_deg_per_s", forecast_json(expected)}});
  for (const TradeOff& row : result.trade_offs)
    table.push_back({{"soaks", row.planned.temperatures.size()},
                     {"planned", soaks_json(row.planned)},
                     {"even", soaks_json(row.even)},
                     {"straight_lines", optional_json(row.straight_lines)}});
  for (const SoakPlan& plan : result.candidates)
    candidates.push_back(soaks_json(plan));
  return {{"schedule", schedule_json(result)},
          {"expected_rms_deg_per_s", forecast_json(result.chosen.expected)},
          {"even", soaks_json(result.even)},
          {"straight_lines", optional_json(result.straight_lines)},
          {"gain_over_straight_lines", gain_json(result)},
          {"candidates", std::move(candidates)},
          {"extrapolated", std::move(extrapolated)},
          {"trade_off", std::move(table)},
          {"range_degC", {result.range.lowest, result.range.highest}},
          {"observed", result.observed},
          {"devices", result.devices},
          {"hysteresis_rms_deg_per_s",
           result.hysteresis ? Json(*result.hysteresis) : Json()},
          {"forecast",
           result.basis == ForecastBasis::kDevices ? "devices" : "gaussian"},
          {"warnings", result.warnings}};
}

}  // namespace beamgyro::internal
