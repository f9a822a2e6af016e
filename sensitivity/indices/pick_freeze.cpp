// SPDX-License-Identifier: MIT
#include "sensitivity/indices/pick_freeze.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "random/random_stream.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {
namespace {

constexpr double kNoVariance = 1e-20;  // [-], of the square of the mean

struct Moments {
  double mean = 0, variance = 0;
  std::size_t rows = 0;
};

// Of both samples over `rows`, where both have a value.
Moments moments_of(const PickFreezeValues& values,
                   std::span<const std::size_t> rows) {
  Moments m;
  double sum = 0;
  for (const std::size_t j : rows) sum += values.a[j] + values.b[j];
  m.rows = rows.size();
  if (m.rows < 2) return m;
  const double count = 2 * static_cast<double>(m.rows);
  m.mean = sum / count;
  for (const std::size_t j : rows) {
    const double a = values.a[j] - m.mean, b = values.b[j] - m.mean;
    m.variance += a * a + b * b;
  }
  m.variance /= count;
  if (m.variance <= kNoVariance * m.mean * m.mean) m.variance = 0;
  return m;
}

struct Ratios {
  double first = 0, total = 0, product = 0;
  std::size_t rows = 0;
};

Ratios ratios_of(const PickFreezeValues& values, std::size_t factor,
                 std::span<const std::size_t> rows, const Moments& moments) {
  Ratios r;
  const std::vector<double>& changed = values.ab[factor];
  for (const std::size_t j : rows) {
    const double ab = changed[j] - moments.mean;
    if (!std::isfinite(ab)) continue;
    const double a = values.a[j] - moments.mean;
    const double b = values.b[j] - moments.mean;
    r.first += b * (ab - a);
    r.total += 0.5 * (a - ab) * (a - ab);
    r.product += a * (a - ab);
    ++r.rows;
  }
  if (r.rows == 0 || moments.variance == 0) return {0, 0, 0, r.rows};
  const double scale = 1 / (static_cast<double>(r.rows) * moments.variance);
  return {r.first * scale, r.total * scale, r.product * scale, r.rows};
}

std::vector<std::size_t> whole_rows(const PickFreezeValues& values) {
  std::vector<std::size_t> rows;
  for (std::size_t j = 0; j < values.a.size(); ++j)
    if (std::isfinite(values.a[j]) && std::isfinite(values.b[j]))
      rows.push_back(j);
  return rows;
}

}  // namespace

IndexEstimate with_interval(double value, std::vector<double> replicates) {
  std::erase_if(replicates, [](double each) { return !std::isfinite(each); });
  if (replicates.empty()) return {value, value, value};
  std::sort(replicates.begin(), replicates.end());
  return {value, percentile(replicates, kIntervalTail),
          percentile(replicates, 1 - kIntervalTail)};
}

PickFreezeIndices pick_freeze_indices(const PickFreezeValues& values,
                                      std::uint64_t seed) {
  const std::size_t factors = values.ab.size();
  const std::vector<std::size_t> rows = whole_rows(values);
  const Moments moments = moments_of(values, rows);
  std::vector<std::vector<double>> firsts(factors), totals(factors);
  std::vector<std::size_t> drawn(rows.size());
  for (std::uint32_t k = 0; k < kResamples && moments.variance > 0; ++k) {
    RandomStream stream(seed, k, 0, kIndexResampleStream);
    for (std::size_t& row : drawn)
      row = rows[static_cast<std::size_t>(stream.uniform() *
                                          static_cast<double>(rows.size()))];
    const Moments again = moments_of(values, drawn);
    for (std::size_t i = 0; i < factors; ++i) {
      const Ratios r = ratios_of(values, i, drawn, again);
      firsts[i].push_back(r.first);
      totals[i].push_back(r.total);
    }
  }
  PickFreezeIndices indices{rows.size(), moments.mean, moments.variance, {}};
  for (std::size_t i = 0; i < factors; ++i) {
    const Ratios r = ratios_of(values, i, rows, moments);
    indices.factors.push_back({with_interval(r.first, std::move(firsts[i])),
                               with_interval(r.total, std::move(totals[i])),
                               r.product, r.rows});
  }
  return indices;
}

}  // namespace beamgyro::internal
