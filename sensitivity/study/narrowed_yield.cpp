// SPDX-License-Identifier: MIT
#include "sensitivity/study/narrowed_yield.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace beamgyro::internal {
namespace {

// Indices of keys, those whose half helps most first.
std::vector<std::size_t> helpful(const YieldResult& yield,
                                 const std::vector<std::string>& keys) {
  std::vector<std::size_t> found;
  for (const HalvedYield& halved : yield.halved)
    if (halved.share && found.size() < kHelpful)
      found.push_back(static_cast<std::size_t>(
          std::ranges::find(keys, halved.key) - keys.begin()));
  return found;
}

// A yield, or an end of its interval, at a width.
struct WidthPoint {
  double width, value;
};

// The widest width at which the straight lines between the points, the widest
// first, reach the target.
std::optional<double> reached(const std::vector<WidthPoint>& points,
                              double target) {
  if (points.front().value >= target) return points.front().width;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto [before, low] = points[k - 1];
    const auto [width, high] = points[k];
    if (high >= target)
      return before + (target - low) / (high - low) * (width - before);
  }
  return {};
}

NeededWidth needed_width(
    const std::string& key, double target,
    const std::vector<std::pair<double, DeviceShare>>& of) {
  std::vector<WidthPoint> value, low, high;
  for (const auto& [width, share] : of) {
    value.push_back({width, share.value});
    low.push_back({width, share.interval.low});
    high.push_back({width, share.interval.high});
  }
  return {key, reached(value, target), reached(low, target),
          reached(high, target)};
}

}  // namespace

void add_pairs(YieldResult& yield, const NarrowingStudy& study,
               DeviceSampleCounts& counts) {
  const std::vector<std::size_t> draws = helpful(yield, study.keys);
  std::vector<Narrowing> pairs;
  for (std::size_t i = 0; i < draws.size(); ++i)
    for (std::size_t j = i + 1; j < draws.size(); ++j)
      pairs.push_back({{draws[i], draws[j]}, 0.5});
  const auto values =
      narrowed_merits(study.campaign, study.options, pairs, counts);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    yield.pairs.push_back({study.keys[pairs[k].draws[0]],
                           study.keys[pairs[k].draws[1]],
                           share_within(values[k], yield.limit)});
  std::ranges::stable_sort(yield.pairs, std::ranges::greater{},
                           [](const PairYield& of) { return of.share.value; });
}

void add_needed(YieldResult& yield, double target, const NarrowingStudy& study,
                DeviceSampleCounts& counts) {
  const std::vector<std::size_t> draws = helpful(yield, study.keys);
  std::vector<Narrowing> tried;
  for (const std::size_t draw : draws)
    for (double width = 1.0 - kNarrowest; width >= kNarrowest;
         width -= kNarrowest)
      tried.push_back({{draw}, width});
  const auto values =
      narrowed_merits(study.campaign, study.options, tried, counts);
  yield.target = target;
  for (const std::size_t draw : draws) {
    std::vector<std::pair<double, DeviceShare>> of = {{1.0, yield.as_is}};
    for (std::size_t k = 0; k < tried.size(); ++k)
      if (tried[k].draws.front() == draw)
        of.emplace_back(tried[k].share, share_within(values[k], yield.limit));
    yield.needed.push_back(needed_width(study.keys[draw], target, of));
  }
  std::ranges::stable_sort(
      yield.needed, std::ranges::greater{},
      [](const NeededWidth& of) { return of.width.value_or(0.0); });
}

}  // namespace beamgyro::internal
