// SPDX-License-Identifier: MIT
#include "compensation/scoring/angle_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kLeastCover = 0.5;  // [-], of the samples of a mean
// Differences summed at a time: what they read stays in the cache.
constexpr Index kBlock = 4096;

using Strided =
    Eigen::Map<const ArrayXd, Eigen::Unaligned, Eigen::InnerStride<>>;

/// Sum of the squares of differences of `sums` that start at `begin`, and every
/// `stride` places after it.
template <int kOrder>
double sum_of_squares(const double* sums, Index m, Index stride, Index size) {
  const auto at = [&](Index shift) {
    return Strided(sums + shift * m, size, Eigen::InnerStride<>(stride));
  };
  const auto next = [&](Index shift) {
    return Eigen::Map<const ArrayXd>(sums + shift * m, size);
  };
  if constexpr (kOrder == 2)
    return stride == 1 ? (next(2) - 2.0 * next(1) + next(0)).square().sum()
                       : (at(2) - 2.0 * at(1) + at(0)).square().sum();
  else
    return stride == 1
               ? (next(3) - 3.0 * next(2) + 3.0 * next(1) - next(0))
                     .square()
                     .sum()
               : (at(3) - 3.0 * at(2) + 3.0 * at(1) - at(0)).square().sum();
}

/// Sum of the shares of the white noise of complete averages over m samples.
double complete_share(int order, Index m) {
  return (order == 3 ? 6.0 : 2.0) / static_cast<double>(m);
}

double second_difference(std::span<const double> sums, Index k, Index m) {
  const auto at = static_cast<std::size_t>(k),
             step = static_cast<std::size_t>(m);
  return sums[at + 2 * step] - 2.0 * sums[at + step] + sums[at];
}

/// Of mdev: the mean of m second differences moves by one of them at a time.
double modified_squares(std::span<const double> sums, Index m, Index starts) {
  double mean = 0.0, squares = 0.0;
  for (Index k = 0; k < m; ++k) mean += second_difference(sums, k, m);
  for (Index k = 0; k < starts; ++k) {
    squares += mean * mean;
    if (k + 1 < starts)
      mean += second_difference(sums, k + m, m) - second_difference(sums, k, m);
  }
  return squares / (static_cast<double>(m) * static_cast<double>(m));
}

/// Of totdev, the differences about the first and the last m - 1 inner places,
/// which reach beyond the ends.
double reflected_squares(std::span<const double> sums, Index m) {
  const auto last = static_cast<Index>(sums.size()) - 1;
  const auto value = [&](Index k) {
    const auto at = [&](Index inside) {
      return sums[static_cast<std::size_t>(inside)];
    };
    if (k < 0) return 2.0 * at(0) - at(-k);
    return k > last ? 2.0 * at(last) - at(2 * last - k) : at(k);
  };
  double squares = 0.0;
  const auto add = [&](Index k) {
    squares += std::pow(value(k + m) - 2.0 * value(k) + value(k - m), 2);
  };
  for (Index k = 1; k < m; ++k) {
    add(k);
    add(last - k);
  }
  return squares;
}

}  // namespace

AngleSums::AngleSums(const std::vector<double>& rates, double mean) {
  const auto places = static_cast<Index>(rates.size());
  sum_ = ArrayXd::Zero(places + 1);
  double sum = 0.0;
  bool whole = true;
  for (Index k = 0; k < places; ++k) {
    const double rate = rates[static_cast<std::size_t>(k)];
    whole = whole && !std::isnan(rate);
    if (!std::isnan(rate)) sum += rate - mean;
    sum_(k + 1) = sum;
  }
  if (whole) return;
  count_ = ArrayXd::Zero(places + 1);
  for (Index k = 0; k < places; ++k)
    count_(k + 1) =
        count_(k) + (std::isnan(rates[static_cast<std::size_t>(k)]) ? 0 : 1);
}

void AngleSums::add(DeviationKind kind, Index m, RateDifferences& total) const {
  if (kind == DeviationKind::kMdev || kind == DeviationKind::kTotdev) {
    for (const auto& [begin, end] : whole_parts()) {
      const std::span<const double> sums(
          sum_.data() + begin, static_cast<std::size_t>(end - begin + 1));
      const Index samples = end - begin;
      const bool is_total = kind == DeviationKind::kTotdev;
      const Index starts = is_total ? samples - 1 : samples - 3 * m + 2;
      if (samples < 2 * m || starts < 1) continue;
      const auto length = static_cast<double>(m);
      const double squares =
          is_total
              ? reflected_squares(sums, m) +
                    sum_of_squares<2>(sums.data(), m, 1, samples - 2 * m + 1)
              : modified_squares(sums, m, starts);
      total.squares += squares / (length * length);
      total.shares += complete_share(2, m) * static_cast<double>(starts);
      total.count += static_cast<double>(starts);
      total.complete += static_cast<double>(starts);
      total.records[samples] += 1.0;
    }
    return;
  }
  const int order = order_of(kind);
  const bool overlaps =
      kind == DeviationKind::kOadev || kind == DeviationKind::kOhdev;
  const Index stride = overlaps ? 1 : m;
  const Index samples = sum_.size() - 1;
  if (samples < order * m) return;
  const Index starts = (samples - order * m) / stride + 1;
  if (count_.size() > 0)
    add_with_gaps(order, m, stride, starts, total);
  else
    add_whole(order, m, stride, starts, total);
  total.complete += static_cast<double>(starts);
  total.records[samples] += 1.0;
}

void AngleSums::add_lag(Index lag, double& squares, double& pairs) const {
  for (Index k = 0; k + lag + 1 < sum_.size(); ++k) {
    if (!has(k) || !has(k + lag)) continue;
    const double difference = sample(k + lag) - sample(k);
    squares += difference * difference;
    pairs += 1.0;
  }
}

std::vector<double> AngleSums::averages(Index m) const {
  std::vector<double> all;
  const auto length = static_cast<double>(m);
  for (Index k = 0; k + m < sum_.size(); k += m) {
    const double count = count_.size() > 0 ? count_(k + m) - count_(k) : length;
    all.push_back(
        count < kLeastCover * length ? NAN : (sum_(k + m) - sum_(k)) / count);
  }
  return all;
}

std::vector<std::pair<Index, Index>> AngleSums::whole_parts() const {
  const Index places = sum_.size() - 1;
  if (count_.size() == 0) return {{0, places}};
  std::vector<std::pair<Index, Index>> parts;
  Index begin = 0;
  for (Index k = 0; k <= places; ++k) {
    if (k < places && has(k)) continue;
    if (k > begin) parts.emplace_back(begin, k);
    begin = k + 1;
  }
  return parts;
}

void AngleSums::add_whole(int order, Index m, Index stride, Index starts,
                          RateDifferences& total) const {
  const auto length = static_cast<double>(m);
  double squares = 0.0;
  for (Index begin = 0; begin < starts; begin += kBlock) {
    const Index size = std::min(kBlock, starts - begin);
    const double* const sums = sum_.data() + begin * stride;
    squares += order == 3 ? sum_of_squares<3>(sums, m, stride, size)
                          : sum_of_squares<2>(sums, m, stride, size);
  }
  total.squares += squares / (length * length);
  total.shares += static_cast<double>(starts) * complete_share(order, m);
  total.count += static_cast<double>(starts);
}

void AngleSums::add_with_gaps(int order, Index m, Index stride, Index starts,
                              RateDifferences& total) const {
  static constexpr std::array kSecond{1.0, -1.0, 0.0};
  static constexpr std::array kThird{1.0, -2.0, 1.0};
  const auto& weights = order == 3 ? kThird : kSecond;
  const double least = kLeastCover * static_cast<double>(m);
  for (Index i = 0; i < starts; ++i) {
    double difference = 0.0, share = 0.0;
    bool counts = true;
    for (int part = 0; counts && part < order; ++part) {
      const Index k = i * stride + part * m;
      const double weight = weights[static_cast<std::size_t>(part)];
      const double count = count_(k + m) - count_(k);
      counts = count >= least;
      difference += weight * (sum_(k + m) - sum_(k)) / count;
      share += weight * weight / count;
    }
    if (!counts) continue;
    total.squares += difference * difference;
    total.shares += share;
    total.count += 1.0;
  }
}

}  // namespace beamgyro::internal
