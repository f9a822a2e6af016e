// SPDX-License-Identifier: MIT
#include "statistics/area_metric.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "random/random_stream.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {
namespace {

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> all(values.begin(), values.end());
  std::ranges::sort(all);
  return all;
}

/// Returns the table's quantile at a share between its first and last.
double tabulated(const TabulatedQuantiles& table, double share) {
  const auto found = std::ranges::lower_bound(table.shares, share);
  const std::size_t above = std::clamp<std::size_t>(
      static_cast<std::size_t>(found - table.shares.begin()), 1,
      table.shares.size() - 1);
  const double low = table.shares[above - 1], high = table.shares[above];
  return table.values[above - 1] +
         (share - low) / (high - low) *
             (table.values[above] - table.values[above - 1]);
}

/// Returns the integral of |f| over an interval in which f is straight.
double straight_area(double width, double begin, double end) {
  const double sum = std::abs(begin) + std::abs(end);
  if (begin * end >= 0) return 0.5 * width * sum;
  return 0.5 * width * (begin * begin + end * end) / sum;
}

}  // namespace

double area_metric(std::span<const double> one, std::span<const double> other) {
  const std::vector<double> a = sorted(one), b = sorted(other);
  const auto of_a = static_cast<double>(a.size());
  const auto of_b = static_cast<double>(b.size());
  std::size_t i = 0, j = 0;  // values that are not above `x`
  double x = std::min(a.front(), b.front()), area = 0;
  while (i < a.size() || j < b.size()) {
    const bool takes_a = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const double next = takes_a ? a[i] : b[j];
    area += (next - x) * std::abs(static_cast<double>(i) / of_a -
                                  static_cast<double>(j) / of_b);
    x = next;
    ++(takes_a ? i : j);
  }
  return area;
}

double area_metric(std::span<const double> sample,
                   const TabulatedQuantiles& table) {
  const std::vector<double> values = sorted(sample);
  const double first = table.shares.front(), last = table.shares.back();
  std::vector<double> borders(table.shares.begin(), table.shares.end());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double share = static_cast<double>(k) /
                         std::max(1.0, static_cast<double>(values.size() - 1));
    if (share > first && share < last) borders.push_back(share);
  }
  std::ranges::sort(borders);
  const auto difference = [&](double share) {
    return percentile(values, share) - tabulated(table, share);
  };
  double area = 0, before = difference(first);
  for (std::size_t k = 1; k < borders.size(); ++k) {
    const double here = difference(borders[k]);
    area += straight_area(borders[k] - borders[k - 1], before, here);
    before = here;
  }
  return area / (last - first);
}

HalfSplit half_split(std::span<const double> sample, std::size_t draws,
                     std::uint64_t seed) {
  std::vector<double> areas;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    RandomStream stream(seed, static_cast<std::uint32_t>(draw), 0,
                        kHalfSplitStream);
    std::vector<double> mixed(sample.begin(), sample.end());
    const std::size_t half = mixed.size() / 2;
    for (std::size_t k = 0; k < half; ++k) {
      const auto left = static_cast<double>(mixed.size() - k);
      const auto chosen = static_cast<std::size_t>(stream.uniform() * left);
      std::swap(mixed[k], mixed[k + chosen]);
    }
    const std::span<const double> all(mixed);
    areas.push_back(area_metric(all.first(half), all.subspan(half)));
  }
  std::ranges::sort(areas);
  return {percentile(areas, 0.5), percentile(areas, 0.95)};
}

}  // namespace beamgyro::internal
