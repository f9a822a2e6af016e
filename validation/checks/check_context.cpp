// SPDX-License-Identifier: MIT
#include "validation/checks/check_context.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"
#include "parallel/work_queue.h"
#include "validation/checks/gain_judge.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {
namespace {

constexpr double kMostMissing = 0.01;    // [-], of the powered samples
constexpr double kSameAnswer = 1e-12;    // [-], of the answer
constexpr double kNotRounded = 0.99e-4;  // [deg/s]

std::size_t missing_answers(const Recording& run, const Answer& answer) {
  std::size_t missing = 0;
  for (std::size_t k = 0; k < run.time.size(); ++k)
    if ((run.status[k] & kUnpowered) == 0 &&
        !(k < answer.rate.size() && std::isfinite(answer.rate[k])))
      ++missing;
  return missing;
}

ScaleFactorCurve curve_of(const CheckedCompensator& all) {
  ScaleFactorCurve curve;
  for (const CheckedRun& run : all.runs)
    for (const auto& [slope, uncertainty] : held_slopes(*run.recording))
      curve.add(slope.temperature, slope.raw / slope.truth, uncertainty);
  return curve;
}

// A table that divides every rate away is left in, and found.
bool is_plausible(const LookupTable& table) {
  return std::ranges::all_of(table.values, [](double s) {
    return s >= kCancelledBelow && s <= 1.0 / kCancelledBelow;
  });
}

std::unique_ptr<const TestedCompensator> stripped(
    const CheckedCompensator& all, const ScaleFactorCurve& curve) {
  if (all.trained == nullptr || !all.trained->scale_factor || !curve.empty() ||
      !is_plausible(*all.trained->scale_factor))
    return nullptr;
  return tested(without_scale_factor(*all.trained));
}

}  // namespace

double smallest_step(const Recording& run, std::span<const double> answers,
                     double ready_after, double least) {
  double smallest = HUGE_VAL;
  for (const SampleRange& stretch : powered_stretches(run))
    for (std::size_t k = stretch.begin + 1;
         k < std::min(stretch.end, answers.size()); ++k) {
      const double one = std::abs(answers[k - 1]), two = std::abs(answers[k]);
      if (!(std::min(one, two) >= least) ||
          run.time[k - 1] - run.time[stretch.begin] <= ready_after)
        continue;
      const double step = std::abs(answers[k] - answers[k - 1]);
      if (step > kSameAnswer * std::max(one, two))
        smallest = std::min(smallest, step);
    }
  return smallest;
}

FittedCompensator without_scale_factor(FittedCompensator compensator) {
  compensator.scale_factor.reset();
  return compensator;
}

std::vector<double> bridged(const Recording& run, std::vector<double> answers) {
  const auto& rate = column_values(run, "rate");
  answers.resize(run.time.size(), std::nan(""));
  double correction = 0.0;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    if ((run.status[k] & kUnpowered) != 0) continue;
    if (std::isfinite(answers[k]))
      correction = rate[k] - answers[k];
    else
      answers[k] = rate[k] - correction;
  }
  return answers;
}

std::vector<double> AlteredAnswers::operator()(const Recording& altered) const {
  Answer answer = compensator_.answer(altered);
  for (const SeenFault& seen : answer.faults)
    seen_[static_cast<std::size_t>(seen.fault)] = true;
  if (missing_answers(altered, answer) > 0)
    seen_[static_cast<std::size_t>(AnswerFault::kNotFinite)] = true;
  const double step =
      smallest_step(altered, answer.rate, ready_after_, 0.5 * full_scale_);
  double least = step_near_full_scale_;
  while (step < least &&
         !step_near_full_scale_.compare_exchange_weak(least, step)) {
  }
  return bridged(altered, std::move(answer.rate));
}

void ScaleFactorCurve::add(double temperature, double scale_factor,
                           double uncertainty) {
  const auto place =
      std::ranges::upper_bound(points_, temperature, {}, &Point::temperature);
  points_.insert(place, {temperature, scale_factor, uncertainty});
}

bool ScaleFactorCurve::has_point_near(double temperature, double reach) const {
  return std::ranges::any_of(points_, [&](const Point& point) {
    return std::abs(point.temperature - temperature) <= reach;
  });
}

double ScaleFactorCurve::at(double temperature) const {
  const auto right =
      std::ranges::upper_bound(points_, temperature, {}, &Point::temperature);
  if (right == points_.begin()) return points_.front().scale_factor;
  if (right == points_.end()) return points_.back().scale_factor;
  const auto left = right - 1;
  const double share = (temperature - left->temperature) /
                       (right->temperature - left->temperature);
  return std::lerp(left->scale_factor, right->scale_factor, share);
}

double ScaleFactorCurve::largest_departure() const {
  double largest = 0.0;
  for (const Point& point : points_)
    largest = std::max(largest, std::abs(point.scale_factor - 1.0));
  return largest;
}

double ScaleFactorCurve::departure_of_corrected(double gain,
                                                double temperature) const {
  const auto right =
      std::ranges::upper_bound(points_, temperature, {}, &Point::temperature);
  const Point& above = right == points_.end() ? points_.back() : *right;
  const Point& below =
      right == points_.begin() ? points_.front() : *(right - 1);
  // Beyond the last point s may go on by twice the mean slope of the curve.
  const double beyond =
      std::max({temperature - points_.back().temperature,
                points_.front().temperature - temperature, 0.0});
  const double span = points_.back().temperature - points_.front().temperature;
  const double on =
      span > 0.0 ? 2.0 * largest_departure() * std::min(beyond / span, 1.0)
                 : 0.0;
  const double low = std::min(above.scale_factor - above.uncertainty,
                              below.scale_factor - below.uncertainty) -
                     on;
  const double high = std::max(above.scale_factor + above.uncertainty,
                               below.scale_factor + below.uncertainty) +
                      on;
  return std::abs(gain / std::clamp(gain, 1.0 / high, 1.0 / low) - 1.0);
}

std::string ScaleFactorCurve::words() const {
  const auto [low, high] =
      std::ranges::minmax(points_, {}, &Point::scale_factor);
  return fmt::format(
      "{:.4f} to {:.4f} at {} point{} of held rates from {:.1f} "
      "to {:.1f} degC",
      low.scale_factor, high.scale_factor, points_.size(),
      points_.size() == 1 ? "" : "s", points_.front().temperature,
      points_.back().temperature);
}

CheckContext::CheckContext(const CheckedCompensator& all, std::size_t count)
    : checked(all),
      threads(count),
      scale_factor(curve_of(all)),
      without_table(stripped(all, scale_factor)),
      ready(ready_compensator(without_table ? *without_table : *all.compensator,
                              all.declared.ready_after)),
      altered(ready           ? *ready
              : without_table ? *without_table
                              : *all.compensator,
              all.full_scale, all.declared.ready_after) {
  double step = HUGE_VAL;
  for (const CheckedRun& run : all.runs) {
    const Recording& recording = *run.recording;
    for (const std::uint8_t status : recording.status)
      samples += (status & kUnpowered) == 0 ? 1 : 0;
    Answer answer = run.answer;
    bridge_until_ready(recording, declared().ready_after, answer);
    missing += missing_answers(recording, answer);
    step = std::min(
        step, smallest_step(recording, answer.rate, declared().ready_after));
    if (without_table)
      answer = (ready ? *ready : *without_table).answer(recording);
    answers.push_back(bridged(recording, std::move(answer.rate)));
  }
  if (std::isfinite(step)) answer_step = step;
}

double CheckContext::resolution() const {
  const bool counts = answer_step >= kNotRounded &&
                      answer_step <= kUndeclaredResolution * (1.0 + 1e-9);
  return std::max(declared().resolution, counts ? answer_step : 0.0);
}

ReplayPauses CheckContext::pauses(double step) const {
  return {declared().settling(step), declared().zeroes_at_power_on};
}

std::optional<Recording> CheckContext::with_rate(
    const Recording& run, std::vector<double>& added) const {
  quieten(run, declared().zeroes_at_power_on, added);
  return with_injected_rate(run, added);
}

GainJudge CheckContext::judge() const {
  return GainJudge(scale_factor, resolution());
}

double CheckContext::coarsest_step() const {
  const double coarse = altered.step_near_full_scale();
  return std::max(answer_step, std::isfinite(coarse) ? coarse : 0.0);
}

std::string CheckContext::rounding_words() const {
  const double step = coarsest_step();
  if (step < kNotRounded) return "";
  return fmt::format(
      " The answers are rounded to {:.3g} deg/s{}.", step,
      step <= resolution() * (1.0 + 1e-9) ? ", which is allowed for" : "");
}

std::vector<std::string> CheckContext::untested_by_replay() const {
  const FittedCompensator* trained = checked.trained;
  const auto range = temperatures_of(runs_of(thermal_purposes()));
  if (!range) return {};
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  // GainJudge holds a table against the curve wherever there is one.
  if (trained != nullptr && trained->scale_factor && scale_factor.empty())
    add("scale_factor");
  std::vector<std::string> read;
  if (trained != nullptr)
    for (const Input& input : trained->inputs) read.push_back(input.column);
  else if (checked.compensator->states_inputs())
    read = checked.compensator->inputs();
  for (double T = range->lowest; T < range->highest + 1.0; T += 1.0) {
    const double here = std::min(T, range->highest);
    if (scale_factor.has_point_near(here, kRateReach)) continue;
    for (const std::string& column : read)
      if (!column.empty() && column != "temperature" && column != "rate" &&
          column != "output")
        add(column);
  }
  return names;
}

bool CheckContext::answered() const {
  return samples > 0 && static_cast<double>(missing) <=
                            kMostMissing * static_cast<double>(samples);
}

std::ptrdiff_t CheckContext::lag_in(const Recording& run) const {
  const double step = usual_step(run);
  if (!random || step == 0.0 || declared().filters()) return 0;
  return static_cast<std::ptrdiff_t>(std::round(random->lag / step));
}

std::vector<std::size_t> CheckContext::runs_of(
    const std::vector<RunPurpose>& purposes) const {
  std::vector<std::size_t> found, every;
  for (std::size_t k = 0; k < checked.runs.size(); ++k) {
    every.push_back(k);
    if (std::ranges::find(purposes, checked.runs[k].purpose) != purposes.end())
      found.push_back(k);
  }
  return found.empty() ? every : found;
}

void CheckContext::for_each(
    const std::vector<std::size_t>& runs,
    const std::function<void(std::size_t)>& work) const {
  for_each_task(runs.size(), threads,
                [&work](std::size_t k, std::size_t) { work(k); });
}

std::optional<TemperatureRange> CheckContext::temperatures_of(
    const std::vector<std::size_t>& runs) const {
  std::vector<const Recording*> all;
  for (const std::size_t k : runs) all.push_back(checked.runs[k].recording);
  return internal::temperatures_of(all);
}

std::vector<RunPurpose> thermal_purposes() {
  return {RunPurpose::kSoak, RunPurpose::kRamp, RunPurpose::kWarmUp,
          RunPurpose::kRest};
}

CheckResult not_tested(std::string why) {
  return {.outcome = CheckOutcome::kNotTested, .words = std::move(why)};
}

}  // namespace beamgyro::internal
