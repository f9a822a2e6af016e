// SPDX-License-Identifier: MIT
#include "planning/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "config/option_message.h"

namespace beamgyro::internal {
namespace {

constexpr double kCandidateStep = 1.0;     // [K]
constexpr std::size_t kFurtherStarts = 4;  // steps from one end to the other
constexpr std::size_t kHoldStep = 4;       // [min], of the first search
constexpr int kHalvings = 6;               // of the way, for the fewest hours
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

std::size_t whole_minutes(const SoakPlan& plan) {
  return static_cast<std::size_t>(std::lround(plan.hold / 60.0));
}

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
                 const ChamberTime& time, SoakBehaviour behaviour)
    : model_(model), time_(time), behaviour_(std::move(behaviour)) {
  const auto& rows = behaviour_.rows;
  while (shortest_ < rows.size() && rows[shortest_].rows < kLeastSteadyRows)
    ++shortest_;
  ++shortest_;
  if (shortest_ > rows.size())
    throw std::invalid_argument(fmt::format(
        "a soak does not settle within {} min; expected a device that settles "
        "faster, or a faster ramp",
        rows.size()));
  if (behaviour_.minutes &&
      (*behaviour_.minutes < shortest_ || *behaviour_.minutes > rows.size()))
    throw option_error(
        "{}: soaks of {} min or more have settled; expected {} to {}",
        NamedOption{"hold_min", std::to_string(*behaviour_.minutes)}, shortest_,
        shortest_, rows.size());
  if (behaviour_.start_row && !model.reaches(behaviour_.start_row->temperature))
    behaviour_.start_row.reset();
  limits_.start = time.start;
  for (double T = chamber.lowest; T <= chamber.highest + 1e-9;
       T += kCandidateStep)
    if (model.reaches(T)) limits_.candidates.push_back(T);
  if (limits_.candidates.empty())
    throw std::invalid_argument(fmt::format(
        "the population knows no temperature of a chamber that reaches {:g} to "
        "{:g} degC; expected another chamber",
        chamber.lowest, chamber.highest));
  even_range_ = {std::max(model.range().lowest, limits_.candidates.front()),
                 std::min(model.range().highest, limits_.candidates.back())};
  if (even_range_.lowest > even_range_.highest)
    even_range_ = {limits_.candidates.front(), limits_.candidates.back()};
}

std::size_t Planner::most_soaks() const {
  const double width = limits_.candidates.back() - limits_.candidates.front();
  const auto apart = static_cast<std::size_t>(width / kLeastDistance) + 1;
  return std::min(apart, kMostSoaks);
}

ChamberTime Planner::time_of(const SoakPlan& plan) const {
  return {time_.start, time_.ramp, plan.hold};
}

// Beam and sensor are still warmer where the chamber was warmer before. The
// first soak has the warm-up after power-on beside the ramp.
std::vector<double> Planner::after_ramps(const std::vector<double>& soaks,
                                         std::size_t minutes,
                                         double SoakRows::*mean) const {
  std::vector<double> found;
  const std::vector<double> order = in_visiting_order(soaks, time_.start);
  for (const double soak : soaks) {
    const auto place = std::ranges::find(order, soak);
    const bool first = place == order.begin();
    const double before = first ? time_.start : *(place - 1);
    const double ramp = std::ceil(std::abs(before - soak) / time_.ramp);
    const double left = mean_after_ramp(
        behaviour_.rows, minutes,
        first ? behaviour_.rows.size() : static_cast<std::size_t>(ramp), mean);
    found.push_back(before > soak ? left : -left);
  }
  return found;
}

// Whether each soak is reached from above (1) or from below (-1).
std::vector<double> Planner::ways(const std::vector<double>& soaks) const {
  std::vector<double> found;
  const std::vector<double> order = in_visiting_order(soaks, time_.start);
  for (const double soak : soaks) {
    const auto place = std::ranges::find(order, soak);
    const double before = place == order.begin() ? time_.start : *(place - 1);
    found.push_back(before > soak ? 1.0 : -1.0);
  }
  return found;
}

Planner::Shown Planner::shown(const std::vector<double>& soaks,
                              std::size_t minutes,
                              const std::optional<StartRow>& row) const {
  SoakErrors errors = {
      after_ramps(soaks, minutes, &SoakRows::mean_lag), {}, ways(soaks)};
  if (row) {
    errors.lag.push_back(row->lag);
    errors.way.push_back(1.0);
  }
  if (behaviour_.noise)
    errors.noise = slow_noise_root(
        *behaviour_.noise, soaks,
        {time_.start, time_.ramp, static_cast<double>(minutes) * 60.0},
        row.has_value());
  if (errors.noise.size() > 0)
    add_noise(behaviour_.temperature_noise * model_.slope(soaks), errors.noise);
  // Where the sensor is by then.
  const std::vector<double> rest =
      after_ramps(soaks, minutes, &SoakRows::mean_rest);
  std::vector<double> read = soaks;
  for (std::size_t k = 0; k < read.size(); ++k)
    if (model_.reaches(read[k] + rest[k])) read[k] += rest[k];
  return {with_start_row(std::move(read), row), std::move(errors)};
}

ResidualForecast Planner::forecast(const SoakModel& model,
                                   const std::vector<double>& soaks,
                                   std::size_t minutes) const {
  const Shown all = shown(soaks, minutes, start_row_of(soaks));
  return forecast_residual(model, all.soaks, all.errors);
}

// Each device with the soaks that were chosen without it.
ResidualDraws Planner::draws(const SoakModel& model,
                             const SoakPlan& plan) const {
  const auto drawn = [&](const std::vector<double>& soaks) {
    const Shown all = shown(soaks, whole_minutes(plan), start_row_of(soaks));
    return residual_draws(model, all.soaks, all.errors);
  };
  ResidualDraws found = drawn(plan.temperatures);
  for (std::size_t k = 0; k < plan.of_folds.size(); ++k)
    if (plan.of_folds[k] != plan.temperatures)
      take_fold(drawn(plan.of_folds[k]), {k, plan.of_folds.size()}, found);
  return found;
}

bool Planner::has_folds() const {
  const Eigen::Index devices = model_.population().coefficients.rows();
  return forecast_basis(model_.population()) == ForecastBasis::kDevices &&
         devices >= static_cast<Eigen::Index>(2 * kFolds) &&
         devices <= kFewDevices;
}

ResidualForecast Planner::left_over(const SoakPlan& plan,
                                    const TemperatureRange& range) const {
  return expected(model_.over(range), plan);
}

ResidualForecast Planner::expected(const SoakModel& model,
                                   const SoakPlan& plan) const {
  return forecast_basis(model.population()) == ForecastBasis::kDevices
             ? forecast_with_intervals(draws(model, plan))
             : forecast(model, plan.temperatures, whole_minutes(plan));
}

ResidualDraws Planner::line_draws(const SoakPlan& even) const {
  const Shown all = shown(even.temperatures, whole_minutes(even), std::nullopt);
  return straight_line_draws(model_, all.soaks, all.errors);
}

std::optional<ResidualForecast> Planner::straight_lines(
    const SoakPlan& even) const {
  if (forecast_basis(model_.population()) != ForecastBasis::kDevices) return {};
  return forecast_with_intervals(line_draws(even));
}

std::optional<MedianRatio> Planner::gain(const SoakPlan& plan,
                                         const SoakPlan& even) const {
  if (forecast_basis(model_.population()) != ForecastBasis::kDevices) return {};
  return ratio_of_medians(draws(model_, plan), line_draws(even));
}

std::size_t Planner::hold_minutes(const std::vector<double>& soaks) const {
  if (behaviour_.minutes) return *behaviour_.minutes;
  const auto median = [&](std::size_t minutes) {
    return forecast(model_, soaks, minutes).median;
  };
  std::size_t best = shortest_;
  double least = median(best);
  for (std::size_t tried = best + kHoldStep; tried <= behaviour_.rows.size();
       tried += kHoldStep) {
    const double now = median(tried);
    if (now > least) break;
    least = now;
    best = tried;
  }
  std::size_t low = shortest_;
  while (low < best) {
    const std::size_t tried = (low + best) / 2;
    if (median(tried) <= (1.0 + kHoldLoss) * least)
      best = tried;
    else
      low = tried + 1;
  }
  return best;
}

double Planner::best_hold(const std::vector<double>& soaks) const {
  return static_cast<double>(hold_minutes(soaks)) * 60.0;
}

SoakPlan Planner::judged_with(std::vector<double> soaks, double hold,
                              std::vector<std::vector<double>> of_folds) const {
  std::ranges::sort(soaks);
  const double hours = chamber_hours(soaks, {time_.start, time_.ramp, hold});
  SoakPlan plan = {std::move(soaks), hold, hours, {}, std::move(of_folds)};
  plan.expected = expected(model_, plan);
  return plan;
}

// Of the best soaks over a way.
SoakPlan Planner::planned_with(std::vector<double> soaks, double hold,
                               double longest) const {
  std::vector<std::vector<double>> of_folds;
  for (std::size_t k = 0; has_folds() && k < kFolds; ++k) {
    auto chosen =
        best(soaks.size(), longest, root_without(model_, {k, kFolds}));
    of_folds.push_back(chosen ? std::move(*chosen) : soaks);
    std::ranges::sort(of_folds.back());
  }
  return judged_with(std::move(soaks), hold, std::move(of_folds));
}

SoakPlan Planner::judged(std::vector<double> soaks) const {
  std::ranges::sort(soaks);
  const double hold = best_hold(soaks);
  return judged_with(std::move(soaks), hold);
}

SoakPlan Planner::even(std::size_t count) const {
  auto known = even_.find(count);
  if (known == even_.end())
    known =
        even_.emplace(count, judged(even_spacing(even_range_, count))).first;
  return known->second;
}

// The way [K] that the holds leave time for.
double Planner::longest_way(std::size_t count, double hours,
                            double hold) const {
  return (hours * 60.0 - static_cast<double>(count) * hold / 60.0) * time_.ramp;
}

std::optional<StartRow> Planner::start_row_of(
    const std::vector<double>& soaks) const {
  const auto& row = behaviour_.start_row;
  return row && has_start_row(soaks, time_.start, *row) ? row : std::nullopt;
}

// The best end of exchanges from several starts.
Planner::Ending Planner::best_of(const DesignLimits& limits, std::size_t count,
                                 const Eigen::MatrixXd& root) const {
  const SoakDesign design(model_, limits, root);
  Ending best;
  std::vector<std::vector<double>> starts = {design.extended({}, count),
                                             even_spacing(even_range_, count)};
  const std::size_t last = limits_.candidates.size() - 1;
  for (std::size_t k = 0; k <= kFurtherStarts; ++k)
    starts.push_back(design.extended(
        {limits_.candidates[last * k / kFurtherStarts]}, count));
  for (std::vector<double>& start : starts) {
    if (start.size() < count || !design.is_allowed(start)) continue;
    start = design.exchanged(std::move(start));
    const double left = design.mean_variance(start);
    if (left < best.mean_variance) best = {std::move(start), left};
  }
  return best;
}

// The soaks of least mean variance over a way, or none that is so short.
std::optional<std::vector<double>> Planner::best(
    std::size_t count, double longest, const Eigen::MatrixXd& root) const {
  if (longest < 0.0) return {};
  DesignLimits limits = limits_;
  limits.longest_way = longest;
  Ending found = best_of(limits, count, root);
  if (behaviour_.start_row) {
    limits.start_row = behaviour_.start_row;
    Ending downwards = best_of(limits, count, root);
    if (downwards.mean_variance < found.mean_variance)
      found = std::move(downwards);
  }
  if (found.soaks.empty()) return {};
  return found.soaks;
}

SoakPlan Planner::with_soaks(std::size_t count) const {
  auto known = planned_.find(count);
  if (known == planned_.end()) {
    const std::optional<std::vector<double>> soaks = best(count, kUnlimited);
    // Greedy soaks may leave gaps that hold no further one apart.
    known = planned_
                .emplace(count, soaks ? planned_with(*soaks, best_hold(*soaks),
                                                     kUnlimited)
                                      : even(count))
                .first;
  }
  return known->second;
}

SoakPlan Planner::within_hours(double hours, double rounding) const {
  if (most_soaks() < 2)
    throw std::invalid_argument(fmt::format(
        "the temperatures hold one soak, and hours choose from two on: soaks "
        "are {:g} K apart or more; expected a wider range",
        kLeastDistance));
  const double most = hours + rounding;
  std::optional<SoakPlan> chosen;
  for (std::size_t count = 2; count <= most_soaks(); ++count) {
    if (longest_way(count, most, static_cast<double>(shortest_) * 60.0) < 0.0)
      break;
    const double hold = with_soaks(count).hold;
    const auto soaks = best(count, longest_way(count, most, hold));
    if (!soaks) continue;
    const SoakPlan plan =
        planned_with(*soaks, hold, longest_way(count, most, hold));
    if (!chosen || plan.expected.median < chosen->expected.median)
      chosen = plan;
  }
  if (!chosen)
    throw std::invalid_argument(fmt::format(
        "{:g} hours are too few for two soaks of {} min or more each and the "
        "ramp between them; expected more hours",
        hours, shortest_));
  return *chosen;
}

// The same number of soaks over the shortest way that is good enough.
SoakPlan Planner::shortened(const SoakPlan& plan, double residual) const {
  SoakPlan shortest = plan;
  double least = 0.0, most = shortest_way(plan.temperatures, time_.start);
  for (int k = 0; k < kHalvings; ++k) {
    const double way = (least + most) / 2;
    const auto soaks = best(plan.temperatures.size(), way);
    const SoakPlan tried =
        soaks ? planned_with(*soaks, plan.hold, way) : SoakPlan{};
    if (soaks && tried.expected.median <= residual) {
      shortest = tried;
      most = way;
    } else {
      least = way;
    }
  }
  return shortest;
}

SoakPlan Planner::within_residual(double residual, double rounding) const {
  const double most = residual + rounding;
  std::optional<SoakPlan> fewest;
  SoakPlan last;
  for (std::size_t count = 1; count <= most_soaks(); ++count) {
    const double holds =
        static_cast<double>(count * shortest_) / 60.0;  // [h], at least
    if (fewest && holds >= fewest->hours) break;
    last = with_soaks(count);
    if (last.expected.median > most) continue;
    const SoakPlan tried = shortened(last, most);
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
    table.push_back(
        {with_soaks(count), even(count), straight_lines(even(count))});
  return table;
}

}  // namespace beamgyro::internal
