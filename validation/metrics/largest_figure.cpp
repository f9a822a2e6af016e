// SPDX-License-Identifier: MIT
#include "validation/metrics/largest_figure.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {
namespace {

constexpr int kHalvings = 40;          // of the bracket of the lower end
constexpr double kExactWithin = 1e-9;  // [-], of a figure

/// Candidates with draws of their noise.
struct NoisyCandidates {
  std::vector<double> values;
  std::vector<std::vector<double>> noise;  // of each draw, all candidates
  std::vector<double> deviations;          // 1-sigma of each
};

NoisyCandidates noisy(const NoisyMeans& means, const Candidates& candidates) {
  NoisyCandidates found{candidates(means.values), {}, {}};
  const std::size_t count = found.values.size();
  found.deviations.assign(count, 0.0);
  std::vector<double> moved(means.values.size());
  const auto draws = draws_of(means);
  for (const std::vector<double>& draw : *draws) {
    std::ranges::transform(means.values, draw, moved.begin(), std::plus<>());
    std::vector<double>& errors = found.noise.emplace_back(candidates(moved));
    for (std::size_t j = 0; j < count; ++j) {
      errors[j] -= found.values[j];
      found.deviations[j] += errors[j] * errors[j];
    }
  }
  for (double& sigma : found.deviations)
    sigma = std::sqrt(sigma / static_cast<double>(found.noise.size()));
  return found;
}

double largest_size(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values)
    largest = std::max(largest, std::abs(value));
  return largest;
}

/// The size that the largest exceeds with a probability of 0.025 where none is
/// beyond +-limit without noise.
double usual_most(const NoisyCandidates& all, double limit) {
  std::vector<double> centres = all.values;
  for (std::size_t j = 0; j < centres.size(); ++j)
    if (std::abs(centres[j]) + all.deviations[j] > limit)
      centres[j] = std::copysign(limit, centres[j]);
  std::vector<double> sizes;
  for (const std::vector<double>& errors : all.noise) {
    double largest = 0.0;
    for (std::size_t j = 0; j < centres.size(); ++j)
      largest = std::max(largest, std::abs(centres[j] + errors[j]));
    sizes.push_back(largest);
  }
  std::ranges::sort(sizes);
  return percentile(sizes, 1.0 - kIntervalTail);
}

double lower_end(const NoisyCandidates& all) {
  const double seen = largest_size(all.values);
  if (usual_most(all, 0.0) >= seen) return 0.0;
  double low = 0.0, high = seen;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (usual_most(all, middle) >= seen ? high : low) = middle;
  }
  return low;
}

double upper_end(const NoisyCandidates& all) {
  double highest = 0.0;
  for (std::size_t j = 0; j < all.values.size(); ++j)
    highest = std::max(
        highest, std::abs(all.values[j]) + kNormal975 * all.deviations[j]);
  return highest;
}

/// Whether the noise is no more than rounding.
bool is_exact(const NoisyCandidates& all, double value) {
  return std::ranges::max(all.deviations) <= kExactWithin * std::abs(value);
}

}  // namespace

Estimate estimate_of_largest(const NoisyMeans& means,
                             const Candidates& candidates) {
  if (lacks_answers(means)) return {NAN};
  const double value = largest_size(candidates(means.values));
  if (means.without_noise() || !std::isfinite(value))
    return {value, Interval{value, value}};
  const NoisyCandidates all = noisy(means, candidates);
  if (is_exact(all, value)) return {value, Interval{value, value}};
  return {value, Interval{lower_end(all), upper_end(all)}};
}

Estimate estimate_of_largest_signed(const NoisyMeans& means,
                                    const Candidates& candidates) {
  if (lacks_answers(means)) return {NAN};
  const std::vector<double> values = candidates(means.values);
  const double value = *std::ranges::max_element(
      values, {}, [](double g) { return std::abs(g); });
  if (means.without_noise() || !std::isfinite(value))
    return {value, Interval{value, value}};
  const NoisyCandidates all = noisy(means, candidates);
  if (is_exact(all, value)) return {value, Interval{value, value}};
  const double least = lower_end(all);
  Interval interval{HUGE_VAL, -HUGE_VAL};
  bool both_signs = !(least > 0.0);
  for (std::size_t j = 0; j < values.size(); ++j) {
    const double half = kNormal975 * all.deviations[j];
    if (std::abs(values[j]) + half < least) continue;
    both_signs = both_signs || values[j] * value < 0.0;
    interval.low = std::min(interval.low, values[j] - half);
    interval.high = std::max(interval.high, values[j] + half);
  }
  if (!both_signs)
    (value > 0.0 ? interval.low : interval.high) = std::copysign(least, value);
  return {value, interval};
}

}  // namespace beamgyro::internal
