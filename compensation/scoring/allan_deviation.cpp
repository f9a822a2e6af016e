// SPDX-License-Identifier: MIT
#include "compensation/scoring/allan_deviation.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "compensation/scoring/angle_sums.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;

constexpr double kTauTolerance = 1e-6;  // [-]

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

/// W of deviation_curves().
double white_variance(const std::vector<AngleSums>& stretches) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index lag : {1, 2}) {
    double squares = 0.0, pairs = 0.0;
    for (const AngleSums& stretch : stretches)
      stretch.add_lag(lag, squares, pairs);
    if (pairs > 0.0) least = std::min(least, squares / pairs / 2.0);
  }
  return std::isfinite(least) ? least : 0.0;
}

/// Deviations of one series, from the shortest tau on.
class SeriesDeviations {
 public:
  explicit SeriesDeviations(const EvenSeries& series)
      : interval_(series.interval) {
    const double mean = mean_of(series);
    for (const auto& rates : series.stretches)
      stretches_.emplace_back(rates, mean);
    if (series.missing > 0) white_ = white_variance(stretches_);
  }

  /// Adds to each curve its point at m samples.
  void add(Index m, std::vector<DeviationSeries>& curves) {
    const RateDifferences plain = sums(DeviationKind::kAdev, m);
    const RateDifferences overlapping = sums(DeviationKind::kOadev, m);
    if (plain.count == 0.0 || !(variance_of(plain, 2, m) >= 0.0) ||
        !(variance_of(overlapping, 2, m) >= 0.0))
      return;
    find_noise(m);
    const auto clusters = static_cast<std::size_t>(plain.count) + 1;
    for (auto& [kind, points] : curves) {
      const RateDifferences found = kind == DeviationKind::kAdev ? plain
                                    : kind == DeviationKind::kOadev
                                        ? overlapping
                                        : sums(kind, m);
      if (found.count > 0.0 && variance_of(found, order_of(kind), m) >= 0.0)
        points.push_back(point(kind, found, m, clusters));
    }
  }

 private:
  RateDifferences sums(DeviationKind kind, Index m) const {
    RateDifferences total;
    for (const AngleSums& stretch : stretches_) stretch.add(kind, m, total);
    return total;
  }

  /// Of white noise in a mean square difference, in place of 1.
  static double norm(int order) { return order == 3 ? 6.0 : 2.0; }

  double variance_of(const RateDifferences& found, int order, Index m) const {
    const double raw = found.squares / (norm(order) * found.count);
    const double excess =
        white_ *
        (found.shares / found.count - norm(order) / static_cast<double>(m)) /
        norm(order);
    return raw - std::max(excess, 0.0);
  }

  void find_noise(Index m) {
    std::vector<std::vector<double>> averages;
    for (const AngleSums& stretch : stretches_)
      averages.push_back(stretch.averages(m));
    noise_ = noise_type(std::move(averages), noise_);
  }

  AllanPoint point(DeviationKind kind, const RateDifferences& found, Index m,
                   std::size_t clusters) const {
    const int order = order_of(kind);
    const double variance = variance_of(found, order, m);
    AllanPoint point{static_cast<double>(m) * interval_, std::sqrt(variance),
                     clusters};
    if (variance > 0.0)
      point.gap_noise = found.squares / (norm(order) * found.count) / variance;
    point.noise = noise_;
    // The mean of the means of records, each weighted with its differences.
    const auto length = static_cast<double>(m);
    double inverse = 0.0, ratio = 0.0, all = 0.0;
    for (const auto& [samples, records] : found.records) {
      const auto places = static_cast<double>(samples);
      const double differences = places - order * length + 1.0;
      inverse += records * differences * differences /
                 equivalent_freedom(kind, noise_, length, places);
      ratio +=
          records * differences * expected_ratio(kind, noise_, length, places);
      all += records * differences;
    }
    point.freedom = all * all / inverse * found.count / found.complete /
                    (point.gap_noise * point.gap_noise);
    point.interval = confidence_interval(
        point.deviation / std::sqrt(ratio / all), point.freedom);
    return point;
  }

  std::vector<AngleSums> stretches_;
  double interval_;
  double white_ = 0.0;  // W of deviation_curves()
  NoiseType noise_ = NoiseType::kWhite;
};

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

}  // namespace

double relative_uncertainty(const AllanPoint& point) {
  return point.gap_noise /
         std::sqrt(2.0 * (static_cast<double>(point.clusters) - 1.0));
}

std::vector<double> octave_taus(std::size_t samples, double interval) {
  std::vector<double> taus;
  for (std::size_t m = 1; m <= samples / 2; m *= 2)
    taus.push_back(static_cast<double>(m) * interval);
  return taus;
}

std::vector<double> octave_taus(const EvenSeries& series) {
  return octave_taus(longest_stretch(series), series.interval);
}

const std::vector<std::string>& tau_spacing_names() {
  static const std::vector<std::string> names{"octave", "decade", "all"};
  return names;
}

std::vector<double> taus_of(const EvenSeries& series, TauSpacing spacing) {
  if (spacing == TauSpacing::kOctave) return octave_taus(series);
  const std::size_t most = longest_stretch(series) / 2;
  std::vector<double> taus;
  const auto add = [&](std::size_t m) {
    if (m <= most) taus.push_back(static_cast<double>(m) * series.interval);
  };
  if (spacing == TauSpacing::kAll)
    for (std::size_t m = 1; m <= most; ++m) add(m);
  else
    for (std::size_t decade = 1; decade <= most; decade *= 10)
      for (const std::size_t step : {1U, 2U, 4U}) add(step * decade);
  return taus;
}

std::vector<DeviationSeries> deviation_curves(
    const EvenSeries& series, std::span<const DeviationKind> kinds,
    std::span<const double> taus, const std::function<void(double)>& advance) {
  const std::size_t longest = longest_stretch(series);
  std::vector<DeviationSeries> curves;
  for (const DeviationKind kind : kinds) curves.push_back({kind, {}});
  SeriesDeviations deviations(series);
  for (std::size_t i = 0; i < taus.size(); ++i) {
    deviations.add(samples_of(taus[i], series.interval, longest), curves);
    if (advance)
      advance(static_cast<double>(i + 1) / static_cast<double>(taus.size()));
  }
  return curves;
}

AllanCurve allan_curve(const EvenSeries& series, std::span<const double> taus) {
  auto curves = deviation_curves(
      series, std::array{DeviationKind::kAdev, DeviationKind::kOadev}, taus);
  return {std::move(curves[0].points), std::move(curves[1].points)};
}

AllanCurve allan_curve(std::span<const double> rates, double interval,
                       std::span<const double> taus) {
  return allan_curve(whole_series(rates, interval), taus);
}

std::vector<SampleRange> gapless_ranges(const Recording& recording,
                                        std::span<const double> values) {
  const auto& time = recording.time;
  const double longest_step = kLongestStep * usual_step(recording);
  std::vector<SampleRange> ranges;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    bool continues = false;
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const bool is_finite = std::isfinite(values[k]);
      continues = continues && time[k] - time[k - 1] <= longest_step;
      if (is_finite && !continues) ranges.push_back({k, k});
      if (is_finite) ranges.back().end = k + 1;
      continues = is_finite;
    }
  }
  return ranges;
}

SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values) {
  SampleRange longest{0, 0};
  for (const SampleRange& range : gapless_ranges(recording, values))
    if (range.size() > longest.size()) longest = range;
  return longest;
}

}  // namespace beamgyro::internal
