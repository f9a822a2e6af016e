// SPDX-License-Identifier: MIT
// Checks by the answers to recordings with an altered rate.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_injection.h"
#include "validation/checks/check_context.h"
#include "validation/checks/gain_judge.h"
#include "validation/checks/random_response.h"

namespace beamgyro::internal {
namespace {

constexpr double kJacobianHold = 4.0;   // [s]
constexpr double kJacobianStep = 0.01;  // [-], of full scale

double temperature_at(const Recording& run, std::size_t k) {
  const Column* temperature = find_column(run, "temperature");
  return temperature == nullptr ? std::nan("") : temperature->values[k];
}

/// The judgement of all runs, with why there is none.
template <class Work>
GainJudge judged_runs(const CheckContext& context,
                      const std::vector<std::size_t>& runs, const Work& work) {
  std::vector<GainJudge> judges(context.checked.runs.size(), context.judge());
  context.for_each(runs, [&](std::size_t k) {
    work(*context.checked.runs[runs[k]].recording, context.answers[runs[k]],
         judges[k]);
  });
  GainJudge all = context.judge();
  for (const GainJudge& judge : judges) all.add(judge);
  return all;
}

const std::string kNoInjection =
    "No run has an output that follows its rate, so that none could be added.";

/// Adds d(answer)/d(rate) at rates held in turn over a run, by the difference
/// between two of them.
void add_jacobian(const CheckContext& context, const Recording& run,
                  GainJudge& judge) {
  const double full_scale = context.checked.full_scale;
  const double step = usual_step(run);
  const ReplayPauses pauses = context.pauses(step);
  const double hold =
      std::max({kJacobianHold, 4.0 * step, 2.0 * pauses.settling});
  const std::size_t samples = run.time.size();
  const std::uint64_t hidden = hidden_number(run);
  std::vector<double> rate(samples), moved(samples), since(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = run.time[k] - run.time.front() + 0.5 * step;
    const double number = std::floor(t / hold);
    since[k] = t - number * hold;
    rate[k] = held_rate(static_cast<std::size_t>(number), full_scale, hidden);
    moved[k] = rate[k] - std::copysign(kJacobianStep * full_scale, rate[k]);
  }
  const auto at_rate = context.with_rate(run, rate);
  const auto at_moved = context.with_rate(run, moved);
  if (!at_rate || !at_moved) return;
  const std::vector<double> one = context.altered(*at_rate),
                            two = context.altered(*at_moved);
  for (std::size_t k = 0; k < samples; ++k)
    if ((run.status[k] & kUnpowered) == 0 && since[k] >= pauses.settling &&
        rate[k] != 0.0)
      judge.add({rate[k], (one[k] - two[k]) / (rate[k] - moved[k]),
                 temperature_at(run, k), run.time[k], rate[k] - moved[k]});
}

}  // namespace

CheckResult check_jacobian(const CheckContext& context) {
  const double full_scale = context.checked.full_scale;
  const GainJudge judge =
      judged_runs(context, context.runs_of(thermal_purposes()),
                  [&](const Recording& run, const auto&, GainJudge& found) {
                    add_jacobian(context, run, found);
                  });
  if (judge.count() == 0) return not_tested(kNoInjection);
  CheckResult result = judge.result();
  const AddedRate& worst = judge.worst();
  result.words =
      judge.passed()
          ? fmt::format(
                "The answer follows small changes of the rate "
                "everywhere within {:g} deg/s.",
                full_scale)
          : fmt::format(
                "The correction depends on the rate itself: of a small "
                "change of the rate at {:.4g} deg/s the answer shows "
                "{:.6g} ({}); expected {}.{}",
                worst.rate, worst.gain, place_words(worst), judge.expected(),
                context.rounding_words());
  return result;
}

namespace {

// Of rounding, the difference of two answers has sqrt(1/6) of a step rms; this
// is twice that, for few samples and for rates that are rounded themselves.
constexpr double kRoundedPair = 0.82;  // [-]

/// A permutation without fixed order: k -> (k stride) mod size, with a stride
/// near the golden section that shares no divisor with the size.
std::size_t golden_stride(std::size_t size) {
  auto stride = static_cast<std::size_t>(0.618 * static_cast<double>(size)) + 1;
  while (std::gcd(stride, size) != 1) ++stride;
  return stride;
}

/// What shuffled samples show: the gain of each plateau, and what of the change
/// of the answers no gain explains.
struct Shuffled {
  GainJudge gains;
  double unexplained = 0.0, change = 0.0;  // [(deg/s)^2], sums of squares
};

/// How many samples are moved together: one, or where a filter is declared so
/// many that it settles within them.
std::size_t samples_moved(const CheckContext& context, const Recording& run) {
  const double step = usual_step(run);
  if (!context.declared().filters() || step == 0.0) return 1;
  return static_cast<std::size_t>(
      std::ceil(3.0 * context.pauses(step).settling / step));
}

void add_plateau(const CheckContext& context, const Recording& run,
                 const SampleRange& plateau, const std::vector<double>& change,
                 const std::vector<double>& difference, Shuffled& found) {
  const std::ptrdiff_t lag = context.lag_in(run);
  const std::size_t moved = samples_moved(context, run);
  const double settling = context.pauses(usual_step(run)).settling;
  double x = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, samples = 0.0;
  for (std::size_t k = plateau.begin; k < plateau.end; ++k) {
    const auto at =
        static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + lag);
    const std::size_t first = k - (k - plateau.begin) % moved;
    if (!is_powered_at(run, at) ||
        (moved > 1 && run.time[k] - run.time[first] < settling))
      continue;
    x += std::abs(change[k]);
    xx += change[k] * change[k];
    xy += change[k] * difference[at];
    yy += difference[at] * difference[at];
    samples += 1.0;
  }
  if (!(xx > 0.0)) return;
  const double full_scale = context.checked.full_scale;
  found.gains.add({.rate = full_scale,
                   .gain = xy / xx,
                   .temperature = temperature_at(run, plateau.begin),
                   .time = run.time[plateau.begin],
                   .change = full_scale,
                   .of_rounding = x / xx});
  const double rounding = kRoundedPair * context.resolution();
  found.unexplained +=
      std::max(yy - xy * xy / xx - samples * rounding * rounding, 0.0);
  found.change += xx;
}

/// The change of the rate of each sample of a plateau when groups of `moved`
/// samples change places: of one sample its own, of more their means.
void add_changes(const std::vector<double>& rate, const SampleRange& plateau,
                 std::size_t moved, std::vector<double>& change) {
  const std::size_t groups = plateau.size() / moved;
  if (groups == 0) return;
  std::vector<double> means(groups, 0.0);
  for (std::size_t k = 0; k < groups * moved; ++k)
    means[k / moved] += rate[plateau.begin + k] / static_cast<double>(moved);
  const std::size_t stride = golden_stride(groups);
  for (std::size_t k = 0; k < groups * moved; ++k)
    change[plateau.begin + k] =
        means[k / moved * stride % groups] - means[k / moved];
}

void add_shuffled(const CheckContext& context, const Recording& run,
                  const std::vector<double>& answers, Shuffled& found) {
  const auto& rate = column_values(run, "rate");
  const auto plateaus = temperature_plateaus(run);
  std::vector<double> change(run.time.size(), 0.0);
  const std::size_t moved = samples_moved(context, run);
  for (const SampleRange& plateau : plateaus)
    add_changes(rate, plateau, moved, change);
  const auto shuffled = context.with_rate(run, change);
  if (!shuffled) return;
  std::vector<double> difference = context.altered(*shuffled);
  for (std::size_t k = 0; k < difference.size(); ++k)
    difference[k] -= answers[k];
  for (const SampleRange& plateau : plateaus)
    add_plateau(context, run, plateau, change, difference, found);
}

}  // namespace

CheckResult check_shuffled_output(const CheckContext& context) {
  const auto runs = context.runs_of(thermal_purposes());
  std::vector<Shuffled> all(runs.size(), {context.judge()});
  context.for_each(runs, [&](std::size_t k) {
    add_shuffled(context, *context.checked.runs[runs[k]].recording,
                 context.answers[runs[k]], all[k]);
  });
  Shuffled sums{context.judge()};
  for (const Shuffled& run : all) {
    sums.gains.add(run.gains);
    sums.unexplained += run.unexplained;
    sums.change += run.change;
  }
  if (!(sums.change > 0.0)) return not_tested(kNoInjection);
  const double value = std::hypot(sums.gains.departure(),
                                  std::sqrt(sums.unexplained / sums.change));
  CheckResult result{.outcome = passed_if(value <= sums.gains.limit()),
                     .value = value,
                     .limit = sums.gains.limit()};
  result.words =
      result.passed()
          ? "The correction stays the same when the output is shuffled among "
            "samples of one temperature."
          : fmt::format(
                "The correction changes by {:.3g} of the change of the "
                "output when the output is shuffled among samples of "
                "one temperature: it is not made from the temperature.{}",
                value, context.rounding_words());
  return result;
}

}  // namespace beamgyro::internal
