// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "api/checked_number.h"
#include "api/compensators.h"
#include "api/scenario_state.h"
#include "api/soak_plan.h"
#include "config/option_message.h"
#include "config/units.h"
#include "dataset/files/json_text.h"
#include "planning/chamber.h"
#include "planning/planner.h"
#include "planning/residual_forecast.h"
#include "planning/schedule_file.h"
#include "planning/soak_length.h"
#include "planning/soak_model.h"
#include "report/plan_report.h"
#include "sim/dynamics/mechanical_noise.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr std::size_t kLeastTable = 7;  // soaks in the table of trade-offs
constexpr Range kChamberTemperatures{-100.0, 200.0};  // [degC]

TemperatureRange checked_range(const char* name, const ChamberRange& range) {
  check_range(name, range.first, range.second, kChamberTemperatures);
  return {range.first, range.second};
}

const Population& population_of(const Compensator& compensator) {
  const FittedCompensator& own = compensator.content().compensator;
  if (!own.population)
    throw std::invalid_argument(fmt::format(
        "{}: kind: \"{}\"; expected a population, which `beamgyro train` "
        "writes with scenarios/population/population.toml",
        compensator.content().path(), kind_name(own.bias)));
  return *own.population;
}

ChamberView view_of(const Device& device) try {
  const DeviceParameters& own = device.content().device;
  return ChamberView(own.thermal, own.temperature_sensor.offset);
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(
      fmt::format("{}: {}", device.name(), error.what()));
}

// What the population knows, in whole kelvins of the chamber.
TemperatureRange known_range(const Population& population,
                             const ChamberView& view) {
  const auto [lowest, highest] = population.range();
  return {std::ceil(view.chamber_temperature(lowest - kReach)),
          std::floor(view.chamber_temperature(highest + kReach))};
}

TemperatureRange chamber_of(const PlanOptions& options,
                            const TemperatureRange& range) {
  return options.chamber_degC
             ? checked_range("chamber_degC", *options.chamber_degC)
             : range;
}

// The parts of the range that the chamber does not reach.
std::vector<TemperatureRange> beyond(const TemperatureRange& chamber,
                                     const TemperatureRange& range) {
  std::vector<TemperatureRange> parts;
  if (chamber.lowest > range.lowest)
    parts.push_back({range.lowest, std::min(chamber.lowest, range.highest)});
  if (chamber.highest < range.highest)
    parts.push_back({std::max(chamber.highest, range.lowest), range.highest});
  return parts;
}

ChamberTime time_of(const PlanOptions& options) {
  check_number("ramp_K_per_min", options.ramp_K_per_min, {0, 100, true, false});
  check_number("start_degC", options.start_degC, kChamberTemperatures);
  ChamberTime time;
  time.start = options.start_degC.value_or(time.start);
  time.ramp = options.ramp_K_per_min.value_or(time.ramp);
  return time;
}

// Flicker is seen by a soak as the floor of its Allan deviation, white noise by
// the fewest rows that a soak has.
SlowNoise slow_noise(const TrimmedGyro& gyro) {
  const NoiseParameters noise = output_noise(gyro);
  const double flicker = std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi) *
                         noise.bias_instability;
  const double white =
      noise.angle_random_walk / std::sqrt(60.0 * kLeastSteadyRows);
  return {noise.turn_on / kDegree, noise.rate_random_walk / kDegree,
          std::hypot(flicker, white) / kDegree};
}

// What the device's thermal model says of soaks and of the minutes after
// power-on, and its noise.
SoakBehaviour behaviour_of(const PlanOptions& options, const TrimmedGyro& gyro,
                           const TemperatureRange& range,
                           const ChamberTime& time) {
  const DeviceParameters& device = gyro.device;
  const double farthest =
      std::abs(range.lowest - time.start) > std::abs(range.highest - time.start)
          ? range.lowest
          : range.highest;
  SoakBehaviour found;
  // A ramp that counts as steady would be taken for dozens of soaks.
  found.rule.steady = std::min(found.rule.steady, time.ramp / 2.0);
  found.rule.lag =
      lag_minutes(device.thermal, time.start, time.ramp, found.rule.steady);
  found.rows = slowest_rows(device.thermal, farthest, time, found.rule);
  const auto row = start_row(device.thermal, range.lowest, time, found.rule);
  if (options.start_row)
    found.start_row = row;
  else
    found.rule.after_power_on =
        row ? std::max(kAfterPowerOn, std::ceil(row->way / time.ramp))
            : kAfterPowerOn;
  found.noise = slow_noise(gyro);
  found.temperature_noise =
      temperature_noise(device.temperature_sensor.resolution, found.rule);
  found.minutes = options.hold_min;
  return found;
}

std::vector<std::string> observed_of(const SoakModel& model, bool bias_only) {
  std::vector<std::string> names = {"bias"};
  if (!bias_only)
    for (const Input& channel : model.population().channels)
      names.push_back(input_name(channel));
  return names;
}

PlannedSchedule schedule_of(const SoakPlan& plan) {
  return {plan.temperatures, plan.hours, plan.expected.median};
}

std::optional<PlanGain> gain_of(const std::optional<MedianRatio>& ratio) {
  if (!ratio) return {};
  return PlanGain{ratio->value, ratio->interval.low, ratio->interval.high};
}

std::vector<double> checked_soaks(std::vector<double> soaks,
                                  const std::string& where,
                                  const TemperatureRange& chamber) {
  const auto fail = [&](const std::string& reason) {
    throw std::invalid_argument(fmt::format(
        "{}: {}; expected temperatures in degC between commas, as in "
        "-40,5,50, or a file with such a list on each line",
        where, reason));
  };
  std::ranges::sort(soaks);
  if (soaks.empty() ||
      !(soaks.front() >= chamber.lowest && soaks.back() <= chamber.highest))
    fail(fmt::format("a soak lies outside the chamber's {:g} to {:g} degC",
                     chamber.lowest, chamber.highest));
  for (std::size_t k = 1; k < soaks.size(); ++k)
    if (soaks[k] - soaks[k - 1] < kPointWidth)
      fail(
          fmt::format("{:g} and {:g} degC are closer together than {:g} K, "
                      "and count as one soak",
                      soaks[k - 1], soaks[k], kPointWidth));
  return soaks;
}

struct PlanStudy {
  PlanStudy(const Compensator& population, const Device& unit,
            const PlanOptions& asked)
      : options(asked),
        view(view_of(unit)),
        range(asked.range_degC ? checked_range("range_degC", *asked.range_degC)
                               : known_range(population_of(population), view)),
        chamber(chamber_of(asked, range)),
        time(time_of(asked)),
        behaviour(behaviour_of(asked, gyro_of(unit), range, time)),
        model(population_of(population),
              [this](const Eigen::ArrayXd& T) {
                return view.sensor_temperatures(T);
              },
              {.range = range,
               .bias_only = asked.bias_only,
               .of_sweep = behaviour.noise}),
        planner(model, chamber, time, behaviour) {}

  // A goal counts as met within the digits that are printed.
  SoakPlan chosen() const {
    constexpr double kHourDigits = 0.005, kResidualDigits = 0.0005;
    if (options.hours) return planner.within_hours(*options.hours, kHourDigits);
    if (options.residual_deg_per_s)
      return planner.within_residual(*options.residual_deg_per_s,
                                     kResidualDigits);
    const std::size_t count = *options.soaks;
    if (count < 1 || count > planner.most_soaks())
      throw option_error("{}: soaks are {:g} K apart or more; expected 1 to {}",
                         NamedOption{"soaks", std::to_string(count)},
                         kLeastDistance, planner.most_soaks());
    return planner.with_soaks(count);
  }

  const PlanOptions& options;
  ChamberView view;
  TemperatureRange range, chamber;  // [degC]
  ChamberTime time;
  SoakBehaviour behaviour;
  SoakModel model;
  Planner planner;
};

}  // namespace

void check_goal(const PlanOptions& options) {
  const int goals = (options.soaks ? 1 : 0) + (options.hours ? 1 : 0) +
                    (options.residual_deg_per_s ? 1 : 0);
  if (goals != 1)
    throw option_error("{} goals given; expected one of {}, {} and {}", goals,
                       NamedOption{"soaks", "N"}, NamedOption{"hours", "H"},
                       NamedOption{"residual_deg_per_s", "R"});
}

SoakPlanResult planned(const Compensator& population, const Device& device,
                       const PlanOptions& options,
                       const std::vector<NamedSoaks>& candidates) {
  check_goal(options);
  population_of(population);
  check_number("hours", options.hours, positive());
  check_number("residual_deg_per_s", options.residual_deg_per_s, positive());
  const PlanStudy s(population, device, options);
  std::vector<std::vector<double>> own;
  for (const auto& [where, soaks] : candidates)
    own.push_back(checked_soaks(soaks, where, s.chamber));
  PlanResult found;
  found.chosen = s.chosen();
  const std::size_t count = found.chosen.temperatures.size();
  found.even = s.planner.even(count);
  found.gain = s.planner.gain(found.chosen, found.even);
  for (const std::vector<double>& soaks : own)
    found.candidates.push_back(s.planner.judged(soaks));
  found.trade_offs = s.planner.trade_offs(
      std::min(std::max(count, kLeastTable), s.planner.most_soaks()));
  found.straight_lines = found.trade_offs.at(count - 1).straight_lines;
  for (const TemperatureRange& part : beyond(s.chamber, s.range))
    found.extrapolated.push_back(
        {part, s.planner.left_over(found.chosen, part)});
  found.time = s.planner.time_of(found.chosen);
  found.rule = s.planner.rule();
  found.range = s.model.range();
  found.observed = observed_of(s.model, options.bias_only);
  found.devices = s.model.population().devices;
  found.devices_tried =
      static_cast<int>(s.model.population().coefficients.rows());
  found.basis = forecast_basis(s.model.population());
  if (found.basis == ForecastBasis::kGaussian)
    found.warnings.push_back(fmt::format(
        "{}: has no coefficients of devices, as an older program wrote it; the "
        "residuals are forecast for normally distributed devices, which real "
        "ones are not; train it again",
        population.content().path()));
  if (s.model.hysteresis_square().size() > 0)
    found.hysteresis = std::sqrt(s.model.hysteresis_square().mean());
  else if (device.content().device.memory.hysteresis)
    found.warnings.push_back(fmt::format(
        "{}: has a hysteresis, and the population was not swept both ways: "
        "what rising and falling temperatures differ by is in no forecast",
        device.name()));
  SoakPlanResult result{.chosen = schedule_of(found.chosen),
                        .even = schedule_of(found.even),
                        .gain = gain_of(found.gain),
                        .warnings = found.warnings};
  for (const SoakPlan& plan : found.candidates)
    result.candidates.push_back(schedule_of(plan));
  for (const TradeOff& trade : found.trade_offs)
    result.trade_offs.push_back(schedule_of(trade.planned));
  result.schedule = schedule_text(
      found.chosen.temperatures, found.time, found.rule,
      options.device_name.empty() ? device.name() : options.device_name);
  result.text = plan_text(found);
  result.json = json_text(plan_json(found));
  return result;
}

}  // namespace internal

SoakPlanResult plan(const Compensator& population, const Device& device,
                    const PlanOptions& options) {
  std::vector<internal::NamedSoaks> candidates;
  for (const std::vector<double>& soaks : options.candidates)
    candidates.push_back(
        {fmt::format("candidate {}", candidates.size() + 1), soaks});
  return internal::planned(population, device, options, candidates);
}

}  // namespace beamgyro
