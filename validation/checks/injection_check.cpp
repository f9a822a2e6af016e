// SPDX-License-Identifier: MIT
// Rates that are added to recordings: held, random and sinusoidal ones.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_injection.h"
#include "validation/checks/check_context.h"
#include "validation/checks/gain_judge.h"
#include "validation/checks/random_response.h"
#include "validation/checks/temperature_sweep.h"

namespace beamgyro::internal {
namespace {

constexpr double kLowestSine = 0.01;   // [Hz]
constexpr double kHighestSine = 20.0;  // [Hz]
constexpr double kSinesPerDecade = 3.0;
constexpr double kSinePeriods = 4.0;  // the first one settles
constexpr double kLeastSine = 20.0;   // samples
constexpr double kPartOfRate = 0.4;   // [-], of the sampling rate

/// The frequencies [Hz] that a run can show.
std::vector<double> sine_frequencies(const Recording& run) {
  const double step = usual_step(run);
  if (step == 0.0) return {};
  const double duration = run.time.back() - run.time.front();
  std::vector<double> frequencies;
  for (int k = 0;; ++k) {
    const double f = kLowestSine * std::pow(10.0, k / kSinesPerDecade);
    if (f > 1.0001 * std::min(kHighestSine, kPartOfRate / step)) break;
    if (kSinePeriods / f <= 0.4 * duration) frequencies.push_back(f);
  }
  return frequencies;
}

/// One sine after the other, repeated until the run ends.
struct SineSegment {
  double frequency;        // [Hz]
  std::size_t begin, end;  // samples
};

std::vector<SineSegment> sine_segments(const Recording& run) {
  const double step = usual_step(run);
  std::vector<SineSegment> segments;
  std::size_t begin = 0;
  for (const double f : sine_frequencies(run)) {
    const double length =
        std::max(std::round(kSinePeriods / f / step), kLeastSine);
    const std::size_t end = begin + static_cast<std::size_t>(length);
    if (end > run.time.size()) break;
    segments.push_back({f, begin, end});
    begin = end;
  }
  return segments;
}

/// Adds the share of each sine in the answers that is in phase with it.
void add_sines(const CheckContext& context, std::size_t number,
               GainJudge& judge) {
  const Recording& run = *context.checked.runs[number].recording;
  const double amplitude = kAddedShare * context.checked.full_scale;
  std::vector<double> added(run.time.size(), 0.0);
  const auto segments = sine_segments(run);
  for (const SineSegment& sine : segments)
    for (std::size_t k = sine.begin; k < sine.end; ++k)
      added[k] = amplitude * std::sin(2.0 * std::numbers::pi * sine.frequency *
                                      (run.time[k] - run.time[sine.begin]));
  const auto found = seen_of_added(context, number, std::move(added));
  if (!found) return;
  const Column* temperature = find_column(run, "temperature");
  for (const SineSegment& sine : segments) {
    double xx = 0.0, xy = 0.0;
    const std::size_t settled =
        sine.begin +
        static_cast<std::size_t>(static_cast<double>(sine.end - sine.begin) /
                                 kSinePeriods);
    for (std::size_t k = settled; k < sine.end; ++k) {
      if (!is_powered_at(run, k)) continue;
      xx += found->added[k] * found->added[k];
      xy += found->added[k] * found->seen[k];
    }
    if (xx > 0.0)
      judge.add({amplitude, xy / xx,
                 temperature ? temperature->values[settled] : std::nan(""),
                 run.time[settled], amplitude});
  }
}

void add_held(const CheckContext& context, std::size_t number,
              GainJudge& judge) {
  const Recording& run = *context.checked.runs[number].recording;
  const auto blocks =
      replay(std::cref(context.altered), run, context.answers[number],
             context.checked.full_scale);
  for (const ReplayedBlock& block :
       blocks.value_or(std::vector<ReplayedBlock>()))
    judge.add({block.rate, block.retained, block.temperature, block.time,
               block.rate});
}

// Rates at temperatures between and beyond the recorded samples: over the range
// that training saw, or over that of the runs.
void add_sweep(const CheckContext& context, std::size_t number,
               GainJudge& judge) {
  const FittedCompensator* trained = context.checked.trained;
  if (trained != nullptr &&
      std::ranges::none_of(trained->inputs, sees_the_rate))
    return;
  const auto range = trained != nullptr
                         ? std::optional(trained->temperature_range)
                         : temperatures_of(context, {number});
  if (!range) return;
  RateEstimator estimator = std::cref(context.altered);
  if (trained != nullptr)
    estimator = [bias_only =
                     without_scale_factor(*trained)](const Recording& any) {
      return compensated_rate(bias_only, any);
    };
  const auto blocks = replays_over_temperature(
      estimator, *context.checked.runs[number].recording, *range,
      context.checked.full_scale,
      trained != nullptr ? kSweepReplays : kSweepReplaysOfProgram);
  for (const ReplayedBlock& block : blocks)
    judge.add({block.rate, block.retained, block.temperature, std::nan(""),
               block.rate});
}

CheckResult failed_injection(const GainJudge& judge,
                             const RandomResponse& random) {
  CheckResult result{.outcome = CheckOutcome::kFailed,
                     .value = judge.departure(),
                     .limit = judge.limit()};
  const AddedRate& worst = judge.worst();
  const std::string found = fmt::format(
      "of {:.4g} deg/s the answers at the same time show {:.6g} ({})",
      worst.rate, worst.gain, place_words(worst));
  result.words =
      random.lag > 0.0
          ? fmt::format("Answers come {:.3g} s late: {}.", random.lag, found)
          : fmt::format(
                "A rate that is added to a recording does not come out "
                "whole: {}.",
                found);
  return result;
}

}  // namespace

CheckResult check_injection(const CheckContext& context) {
  const auto runs = context.runs_of(thermal_purposes());
  std::vector<GainJudge> judges(runs.size() + 1,
                                GainJudge(context.scale_factor));
  context.for_each(
      runs, [&](std::size_t k) { add_held(context, runs[k], judges[k]); });
  add_sines(context, fastest_run(context), judges.back());
  const auto replayed = std::ranges::find_if(
      judges.begin(), judges.end() - 1,
      [](const GainJudge& judge) { return judge.count() > 0; });
  if (replayed != judges.end() - 1)
    add_sweep(context,
              runs[static_cast<std::size_t>(replayed - judges.begin())],
              judges.back());
  GainJudge all(context.scale_factor);
  for (const GainJudge& judge : judges) all.add(judge);
  const std::optional<RandomResponse>& random = context.random;
  if (random)
    all.add({kAddedShare * context.checked.full_scale, random->gain,
             random->temperature, random->time,
             kAddedShare * context.checked.full_scale});
  if (all.count() == 0)
    return not_tested(
        "No run has an output that follows its rate, so that none could be "
        "added.");
  if (!all.passed())
    return failed_injection(all, random.value_or(RandomResponse{}));
  CheckResult result{
      .outcome = CheckOutcome::kPassed,
      .value = all.departure(),
      .limit = all.limit(),
      .words = fmt::format("Rates that are added to the recordings come out "
                           "whole in each of {} places: steps, sines, held for "
                           "up to ten minutes, random.",
                           all.count())};
  if (random &&
      std::abs(random->intercept) > std::max(random->chance, kRateResolution)) {
    result.outcome = CheckOutcome::kFailed;
    result.words = fmt::format(
        "Random rates of zero mean that are added to a recording shift the "
        "answers by {:.3g} deg/s, must be below {:.3g} deg/s.",
        random->intercept, random->chance);
  }
  const std::vector<std::string> untested = context.untested_by_replay();
  if (result.passed() && !untested.empty())
    return not_tested(fmt::format(
        "A rate that is added to a recording cannot tell what {} does, and no "
        "recorded rate does within {:g} K of every temperature of the runs.",
        fmt::join(untested, ", "), kRateReach));
  return result;
}

}  // namespace beamgyro::internal
