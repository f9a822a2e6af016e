// SPDX-License-Identifier: MIT
#include "validation/checks/random_response.h"

#include <algorithm>
#include <cmath>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_injection.h"
#include "validation/checks/gain_judge.h"
#include "validation/checks/white_number.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kLongestRandom = 20000;  // samples
constexpr double kLongestLag = 2.0;            // [s]

double sum_at_lag(const Recording& run, const AddedAndSeen& found,
                  std::ptrdiff_t lag) {
  double sum = 0.0;
  const auto size = static_cast<std::ptrdiff_t>(found.seen.size());
  for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(lag, 0);
       k < std::min(size, size + lag); ++k)
    if (is_powered_at(run, static_cast<std::size_t>(k)))
      sum += found.seen[static_cast<std::size_t>(k)] *
             found.added[static_cast<std::size_t>(k - lag)];
  return sum;
}

double best_lag(const Recording& run, const AddedAndSeen& found) {
  const double step = usual_step(run);
  const auto most = static_cast<std::ptrdiff_t>(std::ceil(kLongestLag / step));
  std::ptrdiff_t best = 0;
  double largest = std::abs(sum_at_lag(run, found, 0));
  for (std::ptrdiff_t lag = -most; lag <= most; ++lag) {
    const double sum = std::abs(sum_at_lag(run, found, lag));
    if (sum <= largest) continue;
    largest = sum;
    best = lag;
  }
  return static_cast<double>(best) * step;
}

}  // namespace

std::optional<AddedAndSeen> seen_of_added(const CheckContext& context,
                                          std::size_t number,
                                          std::vector<double> added) {
  const Recording& run = *context.checked.runs[number].recording;
  const auto moved = context.with_rate(run, added);
  if (!moved) return std::nullopt;
  AddedAndSeen result{std::move(added), context.altered(*moved)};
  for (std::size_t k = 0; k < result.seen.size(); ++k)
    result.seen[k] -= context.answers[number][k];
  return result;
}

bool is_powered_at(const Recording& run, std::size_t k) {
  return k < run.status.size() && (run.status[k] & kUnpowered) == 0;
}

/// The run that is sampled fastest; of several the longest.
std::size_t fastest_run(const CheckContext& context) {
  const auto& runs = context.checked.runs;
  const auto is_better = [](const Recording& x, const Recording& y) {
    const double step = usual_step(x), other = usual_step(y);
    if (step == 0.0 || other == 0.0) return step > other;
    return step != other ? step < other : x.time.size() > y.time.size();
  };
  std::size_t best = 0;
  for (std::size_t k = 1; k < runs.size(); ++k)
    if (is_better(*runs[k].recording, *runs[best].recording)) best = k;
  return best;
}

std::optional<RandomResponse> random_response(const CheckContext& context) {
  const std::size_t number = fastest_run(context);
  const Recording& run = *context.checked.runs[number].recording;
  if (usual_step(run) == 0.0) return std::nullopt;
  std::vector<double> added(run.time.size(), 0.0);
  const std::size_t last = std::min(added.size(), kLongestRandom);
  for (std::size_t k = 0; k < last; ++k)
    added[k] = kAddedShare * context.checked.full_scale * white_number(k);
  const auto found = seen_of_added(context, number, std::move(added));
  if (!found) return std::nullopt;
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, noise = 0.0;
  const std::vector<double>& answers = context.answers[number];
  for (std::size_t k = 1; k < last; ++k) {
    if (!is_powered_at(run, k) || !is_powered_at(run, k - 1)) continue;
    n += 1.0;
    x += found->added[k];
    y += found->seen[k];
    xx += found->added[k] * found->added[k];
    xy += found->added[k] * found->seen[k];
    noise += 0.5 * std::pow(answers[k] - answers[k - 1], 2);
  }
  const double spread = n * xx - x * x;
  if (!(spread > 0.0)) return std::nullopt;
  const Column* temperature = find_column(run, "temperature");
  RandomResponse response;
  response.temperature = temperature ? temperature->values[0] : std::nan("");
  response.time = run.time[0];
  response.gain = (n * xy - x * y) / spread;
  response.intercept = (y - response.gain * x) / n;
  response.chance = 3.0 * std::sqrt(noise) / n;
  if (std::abs(response.gain - 1.0) > kGainTolerance)
    response.lag = best_lag(run, *found);
  return response;
}

}  // namespace beamgyro::internal
