// SPDX-License-Identifier: MIT
#include "validation/specification/decision.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "random/random_stream.h"

namespace beamgyro {

std::string_view verdict_name(Verdict conformity) {
  switch (conformity) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

namespace internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_whole(const std::optional<Estimate>& estimate) {
  return estimate && std::isfinite(estimate->value) &&
         (!estimate->interval || !(std::isnan(estimate->interval->low) ||
                                   std::isnan(estimate->interval->high)));
}

Estimate without_sign(const Estimate& estimate) {
  Estimate result{std::abs(estimate.value)};
  if (estimate.interval) {
    const double low = std::abs(estimate.interval->low);
    const double high = std::abs(estimate.interval->high);
    const bool has_zero =
        estimate.interval->low <= 0.0 && estimate.interval->high >= 0.0;
    result.interval = {has_zero ? 0.0 : std::min(low, high),
                       std::max(low, high)};
  }
  return result;
}

/// ln(a / b), infinite where b is zero.
double log_distance(double a, double b) {
  return b > 0.0 ? std::log(a / b) : kInfinity;
}

/// The quotient of two magnitudes, as decide() says.
std::optional<Estimate> quotient(const Estimate& above, const Estimate& below) {
  if (!(below.value > 0.0)) return std::nullopt;
  Estimate result{above.value / below.value};
  if (!above.interval && !below.interval) return result;
  const Interval a =
      above.interval.value_or(Interval{above.value, above.value});
  const Interval b =
      below.interval.value_or(Interval{below.value, below.value});
  if (!(above.value > 0.0)) {
    result.interval = {0.0, b.low > 0.0 ? a.high / b.low : kInfinity};
    return result;
  }
  const double up = std::hypot(log_distance(a.high, above.value),
                               log_distance(below.value, b.low));
  const double down = std::hypot(log_distance(above.value, a.low),
                                 log_distance(b.high, below.value));
  result.interval = {result.value * std::exp(-down),
                     result.value * std::exp(up)};
  return result;
}

std::optional<Estimate> compared_with(
    const Limit& limit, const std::optional<Estimate>& after,
    const std::optional<Estimate>& reference) {
  if (!is_whole(after)) return std::nullopt;
  if (limit.relative_to.empty())
    return limit.absolute ? without_sign(*after) : *after;
  if (!is_whole(reference)) return std::nullopt;
  return quotient(without_sign(*after), without_sign(*reference));
}

/// A limit on one side, with what lies between it and the value.
struct Side {
  double margin;         // positive within
  double towards, away;  // guard bands when within and when beyond
};

/// The part of an interval of 95 % towards the limit, for another risk. A bias
/// that the interval takes out does not grow with it: less risk adds a multiple
/// of the larger part, which has not lost by that. A widening of 0 leaves
/// nothing of an infinite part, either.
double guard_band(double towards, double other, double widening) {
  if (!(widening > 0.0)) return 0.0;
  return widening > 1.0 ? towards + (widening - 1.0) * std::max(towards, other)
                        : widening * towards;
}

Side side_of(const Estimate& found, double limit, double sign,
             double widening) {
  const Interval interval =
      found.interval.value_or(Interval{found.value, found.value});
  const double high = std::max(interval.high - found.value, 0.0);
  const double low = std::max(found.value - interval.low, 0.0);
  const double above = guard_band(high, low, widening);
  const double below = guard_band(low, high, widening);
  return {sign * (limit - found.value), sign > 0.0 ? above : below,
          sign > 0.0 ? below : above};
}

/// Whether noise hides a size as small as the limit: the interval of one that
/// is never below 0 is wider than the limit.
bool hides(const Estimate& found, const Limit& limit) {
  return limit.most && !limit.least && *limit.most > 0.0 && found.interval &&
         found.interval->low >= 0.0 &&
         found.interval->high - found.interval->low > *limit.most;
}

Verdict conformity_of(const Side& side) {
  if (side.margin >= side.towards) return Verdict::kPass;
  if (-side.margin > side.away) return Verdict::kFail;
  return Verdict::kUndecided;
}

std::string words_of(const Decision& decision, const Limit& limit) {
  const std::string asked = text_of(limit);
  if (!decision.compared)
    return fmt::format(
        "{}, must be {}",
        limit.is_own ? "has no finite value" : "could not be evaluated", asked);
  const double value = decision.compared->value;
  const char* ending = limit.is_own ? "; it has no interval" : "";
  switch (decision.result) {
    case Verdict::kPass:
      return fmt::format("{:.4g} is {} by {:.3g}{}", value, asked,
                         *decision.margin, ending);
    case Verdict::kFail:
      return fmt::format("{:.4g}, must be {}: beyond by {:.3g}{}", value, asked,
                         -*decision.margin, ending);
    case Verdict::kUndecided:
      break;
  }
  if (std::isinf(decision.guard_band))
    return fmt::format(
        "{:.4g} has an interval without an end towards the limit; must be {}",
        value, asked);
  return fmt::format(
      "{:.4g} is within {:.3g} of the limit, its guard band; must be {}{}",
      value, decision.guard_band, asked,
      decision.too_noisy
          ? "; the noise of these runs hides a figure as small as the limit"
          : "");
}

}  // namespace

bool Limit::contains(double value) const {
  return (!least || value >= *least) && (!most || value <= *most);
}

std::string text_of(const Limit& limit) {
  std::string text;
  if (limit.least && limit.most)
    text = fmt::format("{:g} to {:g}", *limit.least, *limit.most);
  else if (limit.most)
    text = fmt::format("at most {:g}", *limit.most);
  else if (limit.least)
    text = fmt::format("at least {:g}", *limit.least);
  if (limit.absolute) text += " in magnitude";
  if (limit.relative_to == "before")
    text += " times the recorded rate's";
  else if (!limit.relative_to.empty())
    text += fmt::format(" times the {}'s", limit.relative_to);
  return text;
}

Verdict worst_of(std::span<const Verdict> all) {
  if (std::ranges::count(all, Verdict::kFail) > 0) return Verdict::kFail;
  return std::ranges::count(all, Verdict::kUndecided) > 0 ? Verdict::kUndecided
                                                          : Verdict::kPass;
}

bool is_more_severe(Verdict one, Verdict other) {
  return one != other && worst_of(std::array{one, other}) == one;
}

Decision decide(const Limit& limit, const std::optional<Estimate>& after,
                const std::optional<Estimate>& reference, double risk) {
  if (!(risk > 0.0 && risk <= 0.5))
    throw std::invalid_argument(fmt::format(
        "false-accept risk: {}, must be a number in (0, 0.5]", risk));
  Decision decision;
  decision.compared = compared_with(limit, after, reference);
  if (decision.compared) {
    const double widening =
        normal_quantile(1.0 - risk) / normal_quantile(0.975);
    std::vector<Side> sides;
    if (limit.most)
      sides.push_back(side_of(*decision.compared, *limit.most, 1.0, widening));
    if (limit.least)
      sides.push_back(
          side_of(*decision.compared, *limit.least, -1.0, widening));
    std::vector<Verdict> results;
    for (const Side& side : sides) results.push_back(conformity_of(side));
    decision.result = worst_of(results);
    const auto nearer = std::ranges::min_element(sides, {}, &Side::margin);
    decision.margin = nearer->margin;
    decision.guard_band =
        nearer->margin >= 0.0 ? nearer->towards : nearer->away;
    decision.too_noisy = decision.result == Verdict::kUndecided &&
                         hides(*decision.compared, limit);
  }
  decision.words = words_of(decision, limit);
  return decision;
}

}  // namespace internal
}  // namespace beamgyro
