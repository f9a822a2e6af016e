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
constexpr double kSinePeriods = 4.0;        // the first one settles
constexpr double kLeastSine = 20.0;         // samples
constexpr double kPartOfRate = 0.4;         // [-], of the sampling rate
constexpr double kDeclaredTolerance = 0.1;  // [-], of a declared response

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

/// What the answers show of a sine: in phase, a quarter of a period late, and
/// of which size, summed over its samples.
struct SineSums {
  double in_phase = 0.0, late = 0.0, square = 0.0;

  double gain() const { return std::hypot(in_phase, late) / square; }
  double delay(double frequency) const {
    return std::atan2(late, in_phase) / (2.0 * std::numbers::pi * frequency);
  }
};

/// A sine that was added, with its answers.
struct SineSeen {
  SineSegment sine;
  std::size_t settled;  // its first sample that counts
  SineSums sums;
};

std::vector<SineSeen> sines_seen(const CheckContext& context,
                                 std::size_t number, double amplitude) {
  const Recording& run = *context.checked.runs[number].recording;
  std::vector<double> added(run.time.size(), 0.0), late = added;
  const auto segments = sine_segments(run);
  for (const SineSegment& sine : segments)
    for (std::size_t k = sine.begin; k < sine.end; ++k) {
      const double phase = 2.0 * std::numbers::pi * sine.frequency *
                           (run.time[k] - run.time[sine.begin]);
      added[k] = amplitude * std::sin(phase);
      late[k] = -amplitude * std::cos(phase);
    }
  const auto found = seen_of_added(context, number, std::move(added));
  if (!found) return {};
  std::vector<SineSeen> all;
  for (const SineSegment& sine : segments) {
    SineSeen seen{sine, sine.begin, {}};
    seen.settled += static_cast<std::size_t>(
        static_cast<double>(sine.end - sine.begin) / kSinePeriods);
    for (std::size_t k = seen.settled; k < sine.end; ++k) {
      // A sample that was set to zero after a power-on does not count.
      if (!is_powered_at(run, k) || found->added[k] == 0.0) continue;
      seen.sums.square += found->added[k] * found->added[k];
      seen.sums.in_phase += found->added[k] * found->seen[k];
      seen.sums.late += late[k] * found->seen[k];
    }
    if (seen.sums.square > 0.0) all.push_back(seen);
  }
  return all;
}

/// The share that comes out, or where a filter is declared what the bounds
/// leave of it: 1 for gains and delays within them, beyond the bandwidth, and
/// beyond the frequency whose half period is the declared delay.
double share_of_sine(const DeclaredResponse& declared, const SineSeen& seen) {
  const SineSums& sums = seen.sums;
  const double f = seen.sine.frequency;
  if (!declared.filters()) return sums.in_phase / sums.square;
  if (f * declared.delay > 0.5 || f > declared.bandwidth.value_or(f))
    return 1.0;
  const double delay = sums.delay(f);
  const double late = std::max(delay - declared.most_delay(f), -delay);
  const double phase = std::clamp(2.0 * std::numbers::pi * f * late, 0.0,
                                  0.5 * std::numbers::pi);
  const double departure = std::max({declared.least_gain(f) - sums.gain(),
                                     sums.gain() - 1.0, std::sin(phase)});
  return departure <= kDeclaredTolerance ? 1.0 : 1.0 - departure;
}

/// Adds the share of each sine that comes out of the answers.
void add_sines(const CheckContext& context, std::size_t number,
               GainJudge& judge) {
  const Recording& run = *context.checked.runs[number].recording;
  const double amplitude = kAddedShare * context.checked.full_scale;
  const Column* temperature = find_column(run, "temperature");
  for (const SineSeen& seen : sines_seen(context, number, amplitude))
    judge.add({.rate = amplitude,
               .gain = share_of_sine(context.declared(), seen),
               .temperature = temperature ? temperature->values[seen.settled]
                                          : std::nan(""),
               .time = run.time[seen.settled],
               .change = amplitude});
}

void add_held(const CheckContext& context, std::size_t number,
              GainJudge& judge) {
  const Recording& run = *context.checked.runs[number].recording;
  const auto blocks =
      replay(std::cref(context.altered), run, context.answers[number],
             context.checked.full_scale, 0, context.pauses(usual_step(run)));
  for (const ReplayedBlock& block :
       blocks.value_or(std::vector<ReplayedBlock>()))
    judge.add({block.rate, block.retained, block.temperature, block.time,
               block.rate});
}

// Whether the bias of a file follows more than the temperature of the sample.
bool remembers(const FittedCompensator& trained) {
  return std::ranges::any_of(
      trained.inputs, [](const Input& input) { return input.parameter > 0.0; });
}

// Rates at temperatures between and beyond the recorded samples: over the range
// that training saw, or over that of the runs. A table of scale factors counts
// where held rates show what it has to be.
void add_sweep(const CheckContext& context, std::size_t number,
               const std::vector<std::size_t>& runs, GainJudge& judge) {
  const FittedCompensator* trained = context.checked.trained;
  const bool has_table = trained != nullptr && trained->scale_factor &&
                         context.without_table == nullptr;
  if (trained != nullptr && !has_table &&
      std::ranges::none_of(trained->inputs, sees_the_rate))
    return;
  const auto range = trained != nullptr
                         ? std::optional(trained->temperature_range)
                         : context.temperatures_of(runs);
  if (!range) return;
  RateEstimator estimator = std::cref(context.altered);
  if (trained != nullptr)
    estimator = [swept = has_table ? *trained : without_scale_factor(*trained)](
                    const Recording& any) {
      return compensated_rate(swept, any);
    };
  std::vector<double> periods = {kSweepPeriod};
  if (trained == nullptr || remembers(*trained))
    periods.push_back(kSettledPeriod);
  for (const double period : periods)
    for (const ReplayedBlock& block : replays_over_temperature(
             estimator, *context.checked.runs[number].recording, *range,
             context.checked.full_scale,
             trained != nullptr ? kSweepReplays : kSweepReplaysOfProgram,
             context.pauses(period), period))
      judge.add({block.rate, block.retained, block.temperature, std::nan(""),
                 block.rate});
}

CheckResult failed_injection(const CheckContext& context,
                             const GainJudge& judge,
                             const RandomResponse& random) {
  CheckResult result = judge.result();
  const AddedRate& worst = judge.worst();
  const std::string found = fmt::format(
      "of {:.4g} deg/s the answers at the same time show {:.6g} ({}); expected "
      "{}",
      worst.rate, worst.gain, place_words(worst), judge.expected());
  result.words =
      random.lag > 0.0
          ? fmt::format("Answers come {:.3g} s late: {}.", random.lag, found)
          : fmt::format(
                "A rate that is added to a recording does not come out "
                "whole: {}.",
                found);
  result.words += context.rounding_words();
  return result;
}

}  // namespace

std::vector<SineResponse> sine_responses(const CheckContext& context,
                                         std::size_t number) {
  std::vector<SineResponse> all;
  for (const SineSeen& seen :
       sines_seen(context, number, kAddedShare * context.checked.full_scale))
    all.push_back({seen.sine.frequency, seen.sums.gain(),
                   seen.sums.delay(seen.sine.frequency)});
  return all;
}

CheckResult check_injection(const CheckContext& context) {
  auto runs = context.runs_of(thermal_purposes());
  for (std::size_t k = 0; k < context.checked.runs.size(); ++k)
    if (context.checked.runs[k].is_limited && std::ranges::count(runs, k) == 0)
      runs.push_back(k);
  std::vector<GainJudge> judges(runs.size() + 1, context.judge());
  context.for_each(
      runs, [&](std::size_t k) { add_held(context, runs[k], judges[k]); });
  add_sines(context, fastest_run(context), judges.back());
  const auto replayed = std::ranges::find_if(
      judges.begin(), judges.end() - 1,
      [](const GainJudge& judge) { return judge.count() > 0; });
  if (replayed != judges.end() - 1)
    add_sweep(context,
              runs[static_cast<std::size_t>(replayed - judges.begin())], runs,
              judges.back());
  GainJudge all = context.judge();
  for (const GainJudge& judge : judges) all.add(judge);
  // A rate that is new at each sample lies beyond what a filter promises.
  const std::optional<RandomResponse> random =
      context.declared().filters() ? std::nullopt : context.random;
  if (random)
    all.add({kAddedShare * context.checked.full_scale, random->gain,
             random->temperature, random->time,
             kAddedShare * context.checked.full_scale});
  if (all.count() == 0)
    return not_tested(
        "No run has an output that follows its rate, so that none could be "
        "added.");
  if (!all.passed())
    return failed_injection(context, all, random.value_or(RandomResponse{}));
  CheckResult result = all.result();
  result.words = fmt::format(
      "Rates that are added to the recordings come out whole in each of {} "
      "places: steps, sines, held for up to ten minutes, random.{}",
      all.count(), context.rounding_words());
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
