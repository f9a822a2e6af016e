// SPDX-License-Identifier: MIT
#include "compensation/scoring/allan_deviation.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kTauTolerance = 1e-6;  // [-]
constexpr double kLeastCover = 0.5;     // [-], of the samples of a mean
// Differences summed at a time: what they read stays in the cache.
constexpr Index kBlock = 4096;

[[noreturn]] void fail_series(const std::string& message) {
  throw std::invalid_argument(message);
}

Index samples_of(double tau, double interval, std::size_t longest) {
  const double ratio = tau / interval;
  const double m = std::round(ratio);
  if (!(m >= 1.0 && std::abs(ratio - m) <= kTauTolerance * ratio))
    fail_series(
        fmt::format("tau: {} s, must be a multiple of the interval of {} s",
                    tau, interval));
  if (!(2.0 * m <= static_cast<double>(longest)))
    fail_series(
        fmt::format("tau: {} s, must be at most half of the record of {} s",
                    tau, static_cast<double>(longest) * interval));
  return static_cast<Index>(m);
}

std::size_t longest_stretch(const EvenSeries& series) {
  std::size_t longest = 0;
  for (const auto& stretch : series.stretches)
    longest = std::max(longest, stretch.size());
  return longest;
}

double mean_of(const EvenSeries& series) {
  double sum = 0.0, count = 0.0;
  for (const auto& stretch : series.stretches)
    for (const double rate : stretch)
      if (!std::isnan(rate)) {
        sum += rate;
        count += 1.0;
      }
  return sum / count;
}

/// Of the differences Y_{k+m} - Y_k at one tau.
struct Differences {
  double squares = 0.0;
  double shares = 0.0;  // sum of 1/n_k + 1/n_{k+m}
  double count = 0.0;
};

/// The sums of a stretch up to each place, of which differences are means. The
/// mean rate is taken off: it cancels, and without it the sums stay small.
class Stretch {
 public:
  Stretch(const std::vector<double>& rates, double mean) {
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

  /// Adds the differences that start at every `stride`-th place.
  void add(Index m, Index stride, Differences& total) const {
    if (sum_.size() < 2 * m + 1) return;
    const Index starts = (sum_.size() - 2 * m - 1) / stride + 1;
    if (count_.size() > 0)
      add_with_gaps(m, stride, starts, total);
    else
      add_whole(m, stride, starts, total);
  }

  /// Adds the squares of differences of samples `lag` apart.
  void add_lag(Index lag, double& squares, double& pairs) const {
    for (Index k = 0; k + lag + 1 < sum_.size(); ++k) {
      if (!has(k) || !has(k + lag)) continue;
      const double difference = sample(k + lag) - sample(k);
      squares += difference * difference;
      pairs += 1.0;
    }
  }

 private:
  bool has(Index k) const {
    return count_.size() == 0 || count_(k + 1) > count_(k);
  }
  double sample(Index k) const { return sum_(k + 1) - sum_(k); }

  void add_whole(Index m, Index stride, Index starts,
                 Differences& total) const {
    using Strided =
        Eigen::Map<const ArrayXd, Eigen::Unaligned, Eigen::InnerStride<>>;
    const auto length = static_cast<double>(m);
    double squares = 0.0;
    for (Index begin = 0; begin < starts; begin += kBlock) {
      const Index size = std::min(kBlock, starts - begin);
      const auto sums = [&](Index shift) {
        return sum_.segment(begin + shift, size);
      };
      const auto strided = [&](Index shift) {
        return Strided(sum_.data() + begin * stride + shift, size,
                       Eigen::InnerStride<>(stride));
      };
      squares +=
          stride == 1
              ? (sums(2 * m) - 2.0 * sums(m) + sums(0)).square().sum()
              : (strided(2 * m) - 2.0 * strided(m) + strided(0)).square().sum();
    }
    total.squares += squares / (length * length);
    total.shares += static_cast<double>(starts) * 2.0 / length;
    total.count += static_cast<double>(starts);
  }

  void add_with_gaps(Index m, Index stride, Index starts,
                     Differences& total) const {
    const double least = kLeastCover * static_cast<double>(m);
    for (Index i = 0; i < starts; ++i) {
      const Index k = i * stride;
      const double before = count_(k + m) - count_(k);
      const double after = count_(k + 2 * m) - count_(k + m);
      if (before < least || after < least) continue;
      const double first = sum_(k + m) - sum_(k);
      const double second = sum_(k + 2 * m) - sum_(k + m);
      const double share = 1.0 / (before * after);
      const double difference = (second * before - first * after) * share;
      total.squares += difference * difference;
      total.shares += (before + after) * share;
      total.count += 1.0;
    }
  }

  ArrayXd sum_;
  ArrayXd count_;  // of samples up to each place; empty without a gap
};

/// W of allan_curve().
double white_variance(const std::vector<Stretch>& stretches) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index lag : {1, 2}) {
    double squares = 0.0, pairs = 0.0;
    for (const Stretch& stretch : stretches)
      stretch.add_lag(lag, squares, pairs);
    if (pairs > 0.0) least = std::min(least, squares / pairs / 2.0);
  }
  return std::isfinite(least) ? least : 0.0;
}

AllanPoint point_of(const Differences& found, Index m, double interval,
                    double white, std::size_t clusters) {
  const auto length = static_cast<double>(m);
  const double raw = found.squares / (2.0 * found.count);
  const double excess = white * (found.shares / found.count - 2.0 / length) / 2;
  const double variance = raw - std::max(excess, 0.0);
  return {length * interval, variance >= 0.0 ? std::sqrt(variance) : NAN,
          clusters, variance > 0.0 ? raw / variance : 1.0};
}

EvenSeries whole_series(std::span<const double> rates, double interval) {
  if (!(std::isfinite(interval) && interval > 0.0))
    fail_series(fmt::format("interval: {} s, must be positive", interval));
  if (rates.size() < 2)
    fail_series(fmt::format("rates: {}, must be at least two", rates.size()));
  for (std::size_t k = 0; k < rates.size(); ++k)
    if (!std::isfinite(rates[k]))
      fail_series(
          fmt::format("rate {}: {} is not finite; an Allan deviation needs a "
                      "series without holes",
                      k, rates[k]));
  EvenSeries series;
  series.stretches.emplace_back(rates.begin(), rates.end());
  series.interval = interval;
  series.samples = rates.size();
  return series;
}

nlohmann::ordered_json list(const std::vector<AllanPoint>& points) {
  auto all = nlohmann::ordered_json::array();
  for (const AllanPoint& point : points) {
    all.push_back({{"tau_s", point.tau},
                   {"deviation", point.deviation},
                   {"clusters", point.clusters}});
  }
  return all;
}

}  // namespace

double relative_uncertainty(const AllanPoint& point) {
  return point.gap_noise /
         std::sqrt(2.0 * (static_cast<double>(point.clusters) - 1.0));
}

std::vector<double> octave_taus(std::size_t samples, double interval) {
  std::vector<double> taus;
  for (std::size_t m = 1; m <= samples / 2; m *= 2) {
    taus.push_back(static_cast<double>(m) * interval);
  }
  return taus;
}

std::vector<double> octave_taus(const EvenSeries& series) {
  return octave_taus(longest_stretch(series), series.interval);
}

AllanCurve allan_curve(const EvenSeries& series, std::span<const double> taus) {
  const double mean = mean_of(series);
  std::vector<Stretch> stretches;
  for (const auto& rates : series.stretches)
    stretches.emplace_back(rates, mean);
  const double white = series.missing > 0 ? white_variance(stretches) : 0.0;
  AllanCurve curve;
  for (const double tau : taus) {
    const Index m = samples_of(tau, series.interval, longest_stretch(series));
    Differences plain, overlapping;
    for (const Stretch& stretch : stretches) {
      stretch.add(m, m, plain);
      stretch.add(m, 1, overlapping);
    }
    if (plain.count == 0.0) continue;
    const auto clusters = static_cast<std::size_t>(plain.count) + 1;
    const AllanPoint first =
        point_of(plain, m, series.interval, white, clusters);
    const AllanPoint second =
        point_of(overlapping, m, series.interval, white, clusters);
    if (std::isnan(first.deviation) || std::isnan(second.deviation)) continue;
    curve.plain.push_back(first);
    curve.overlapping.push_back(second);
  }
  return curve;
}

std::vector<AllanPoint> adev(std::span<const double> rates, double interval,
                             std::span<const double> taus) {
  return allan_curve(whole_series(rates, interval), taus).plain;
}

std::vector<AllanPoint> oadev(std::span<const double> rates, double interval,
                              std::span<const double> taus) {
  return allan_curve(whole_series(rates, interval), taus).overlapping;
}

SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values) {
  const auto& time = recording.time;
  const double longest_step = kLongestStep * usual_step(recording);
  SampleRange longest{0, 0};
  for (const SampleRange& stretch : powered_stretches(recording)) {
    std::size_t begin = stretch.begin;
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      if (!std::isfinite(values[k])) {
        begin = k + 1;
      } else if (k > begin && time[k] - time[k - 1] > longest_step) {
        begin = k;
      }
      if (k + 1 > begin + longest.size()) {
        longest = {begin, k + 1};
      }
    }
  }
  return longest;
}

nlohmann::ordered_json to_json(const AllanCurve& curve) {
  nlohmann::ordered_json json;
  json["adev"] = list(curve.plain);
  json["oadev"] = list(curve.overlapping);
  return json;
}

}  // namespace beamgyro
