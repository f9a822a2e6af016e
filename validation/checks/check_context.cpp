// SPDX-License-Identifier: MIT
#include "validation/checks/check_context.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"
#include "parallel/work_queue.h"
#include "validation/checks/gain_judge.h"
#include "validation/external/file_compensator.h"

namespace beamgyro::internal {
namespace {

constexpr double kMostMissing = 0.01;  // [-], of the powered samples

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
    for (const PlateauSlope& plateau :
         plateau_slopes(*run.recording, kTableRate))
      curve.add(plateau.temperature, plateau.raw / plateau.truth);
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
  return bridged(altered, std::move(answer.rate));
}

void ScaleFactorCurve::add(double temperature, double scale_factor) {
  const auto place =
      std::ranges::upper_bound(points_, temperature, {}, &Point::temperature);
  points_.insert(place, {temperature, scale_factor});
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
  const double above =
      (right == points_.end() ? points_.back() : *right).scale_factor;
  const double below =
      (right == points_.begin() ? points_.front() : *(right - 1)).scale_factor;
  const auto [low, high] = std::minmax(above, below);
  return std::abs(gain / std::clamp(gain, 1.0 / high, 1.0 / low) - 1.0);
}

CheckContext::CheckContext(const CheckedCompensator& all, std::size_t count)
    : checked(all),
      threads(count),
      scale_factor(curve_of(all)),
      without_table(stripped(all, scale_factor)),
      altered(without_table ? *without_table : *all.compensator) {
  for (const CheckedRun& run : all.runs) {
    const Recording& recording = *run.recording;
    for (const std::uint8_t status : recording.status)
      samples += (status & kUnpowered) == 0 ? 1 : 0;
    missing += missing_answers(recording, run.answer);
    answers.push_back(
        bridged(recording, without_table ? without_table->answer(recording).rate
                                         : run.answer.rate));
  }
}

std::vector<std::string> CheckContext::untested_by_replay() const {
  const FittedCompensator* trained = checked.trained;
  const auto range = temperatures_of(*this, runs_of(thermal_purposes()));
  if (trained == nullptr || !range) return {};
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  // GainJudge holds a table against the curve wherever there is one.
  if (trained->scale_factor && scale_factor.empty()) add("scale_factor");
  for (double T = range->lowest; T < range->highest + 1.0; T += 1.0) {
    const double here = std::min(T, range->highest);
    if (scale_factor.has_point_near(here, kRateReach)) continue;
    for (const Input& input : trained->inputs)
      if (!sees_the_rate(input) && !input.column.empty() &&
          input.column != "temperature")
        add(input.column);
  }
  return names;
}

bool CheckContext::answered() const {
  return samples > 0 && static_cast<double>(missing) <=
                            kMostMissing * static_cast<double>(samples);
}

std::ptrdiff_t CheckContext::lag_in(const Recording& run) const {
  const double step = usual_step(run);
  if (!random || step == 0.0) return 0;
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

std::optional<TemperatureRange> temperatures_of(
    const CheckContext& context, const std::vector<std::size_t>& runs) {
  TemperatureRange range = {HUGE_VAL, -HUGE_VAL};
  for (const std::size_t number : runs) {
    const Recording& run = *context.checked.runs[number].recording;
    const Column* temperature = find_column(run, "temperature");
    if (temperature == nullptr) return std::nullopt;
    for (const SampleRange& stretch : powered_stretches(run))
      for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
        range.lowest = std::min(range.lowest, temperature->values[k]);
        range.highest = std::max(range.highest, temperature->values[k]);
      }
  }
  if (!(range.lowest <= range.highest)) return std::nullopt;
  return range;
}

std::vector<RunPurpose> thermal_purposes() {
  return {RunPurpose::kSoak, RunPurpose::kRamp, RunPurpose::kWarmUp,
          RunPurpose::kRest};
}

CheckResult not_tested(std::string why) {
  return {.outcome = CheckOutcome::kNotTested, .words = std::move(why)};
}

}  // namespace beamgyro::internal
