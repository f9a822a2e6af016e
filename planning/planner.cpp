// SPDX-License-Identifier: MIT
#include "planning/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace beamgyro {
namespace {

constexpr double kCandidateStep = 1.0;     // [K]
constexpr std::size_t kFurtherStarts = 4;  // steps from one end to the other
constexpr int kHalvings = 6;               // of the way, for the fewest hours
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<double> even_spacing(TemperatureRange range, std::size_t count) {
  if (count == 1) return {(range.lowest + range.highest) / 2};
  std::vector<double> soaks;
  for (std::size_t k = 0; k < count; ++k)
    soaks.push_back(
        std::lerp(range.lowest, range.highest,
                  static_cast<double>(k) / static_cast<double>(count - 1)));
  return soaks;
}

Planner::Planner(const SoakModel& model, TemperatureRange chamber,
                 const ChamberTime& time)
    : model_(model), time_(time) {
  limits_.start = time.start;
  for (double T = chamber.lowest; T <= chamber.highest + 1e-9;
       T += kCandidateStep)
    if (model.reaches(T)) limits_.candidates.push_back(T);
}

std::size_t Planner::most_soaks() const {
  const double width = limits_.candidates.back() - limits_.candidates.front();
  const auto apart = static_cast<std::size_t>(width / kLeastDistance) + 1;
  return std::min(apart, kMostSoaks);
}

SoakPlan Planner::judged(std::vector<double> soaks) const {
  std::ranges::sort(soaks);
  const double hours = chamber_hours(soaks, time_);
  const ResidualForecast expected = forecast_residual(model_, soaks);
  return {std::move(soaks), hours, expected};
}

SoakPlan Planner::even(std::size_t count) const {
  return judged(even_spacing(model_.range(), count));
}

// The way [K] that the holds leave time for.
double Planner::longest_way(std::size_t count, double hours) const {
  return (hours * 60.0 - static_cast<double>(count) * time_.hold / 60.0) *
         time_.ramp;
}

// The soaks of least mean variance over a way, or none that is so short.
std::optional<std::vector<double>> Planner::best(std::size_t count,
                                                 double longest) const {
  if (longest < 0.0) return {};
  DesignLimits limits = limits_;
  limits.longest_way = longest;
  const SoakDesign design(model_, std::move(limits));
  std::optional<std::vector<double>> found;
  double least = HUGE_VAL;
  std::vector<std::vector<double>> starts = {
      design.extended({}, count), even_spacing(model_.range(), count)};
  const std::size_t last = limits_.candidates.size() - 1;
  for (std::size_t k = 0; k <= kFurtherStarts; ++k)
    starts.push_back(design.extended(
        {limits_.candidates[last * k / kFurtherStarts]}, count));
  for (std::vector<double>& start : starts) {
    if (start.size() < count || !design.is_allowed(start)) continue;
    start = design.exchanged(std::move(start));
    const double left = design.mean_variance(start);
    if (left < least) {
      least = left;
      found = std::move(start);
    }
  }
  return found;
}

SoakPlan Planner::with_soaks(std::size_t count) const {
  const std::optional<std::vector<double>> soaks = best(count, kUnlimited);
  // Greedy soaks may leave gaps that hold no further one apart.
  return soaks ? judged(*soaks) : even(count);
}

SoakPlan Planner::within_hours(double hours) const {
  std::optional<std::vector<double>> chosen;
  const SoakDesign design(model_, limits_);
  for (std::size_t count = 2; count <= most_soaks(); ++count) {
    const auto soaks = best(count, longest_way(count, hours));
    if (!soaks) continue;
    if (!chosen || design.mean_variance(*soaks) < design.mean_variance(*chosen))
      chosen = soaks;
  }
  if (!chosen)
    throw std::invalid_argument(fmt::format(
        "{:g} hours are too few for two soaks of {:g} min each and the ramp "
        "between them; expected more hours",
        hours, time_.hold / 60.0));
  return judged(*chosen);
}

// The same number of soaks over the shortest way that is good enough.
SoakPlan Planner::shortened(const SoakPlan& plan, double residual) const {
  SoakPlan shortest = plan;
  double least = 0.0, most = shortest_way(plan.temperatures, time_.start);
  for (int k = 0; k < kHalvings; ++k) {
    const double way = (least + most) / 2;
    const auto soaks = best(plan.temperatures.size(), way);
    const SoakPlan tried = soaks ? judged(*soaks) : SoakPlan{};
    if (soaks && tried.expected.median <= residual) {
      shortest = tried;
      most = way;
    } else {
      least = way;
    }
  }
  return shortest;
}

SoakPlan Planner::within_residual(double residual) const {
  std::optional<SoakPlan> fewest;
  SoakPlan last;
  for (std::size_t count = 1; count <= most_soaks(); ++count) {
    const double holds = static_cast<double>(count) * time_.hold / 3600.0;
    if (fewest && holds >= fewest->hours) break;
    last = with_soaks(count);
    if (last.expected.median > residual) continue;
    const SoakPlan tried = shortened(last, residual);
    if (!fewest || tried.hours < fewest->hours) fewest = tried;
  }
  if (!fewest)
    throw std::invalid_argument(fmt::format(
        "a median residual of {:g} deg/s is out of reach: {} soaks leave "
        "{:.3g} deg/s; expected more than that",
        residual, last.temperatures.size(), last.expected.median));
  return *fewest;
}

std::vector<TradeOff> Planner::trade_offs(std::size_t most) const {
  std::vector<TradeOff> table;
  for (std::size_t count = 1; count <= most; ++count)
    table.push_back({with_soaks(count), even(count)});
  return table;
}

}  // namespace beamgyro
