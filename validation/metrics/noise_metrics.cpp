// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "validation/metrics/allan_ratio.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

constexpr double kHour = 3600.0;  // [s]
constexpr std::size_t kLeastRestSamples = 64;
// Of a residual whose deviation falls from 1 s to 4 s as that of white noise.
constexpr std::size_t kLeastSeconds = 10;

/// Residual [deg/s] of the longest gapless stretch at rest, evenly sampled.
struct RestSeries {
  std::vector<double> residual;
  double interval = 0.0;  // [s]
};

RestSeries rest_series(const Evidence& evidence) {
  RestSeries longest;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRest})) {
    const SampleRange range = longest_gapless_range(*run->recording, run->rate);
    if (range.size() < kLeastRestSamples ||
        range.size() <= longest.residual.size())
      continue;
    const std::vector<double> residual = residual_of(*run);
    const auto& time = run->recording->time;
    longest.residual.assign(
        residual.begin() + static_cast<std::ptrdiff_t>(range.begin),
        residual.begin() + static_cast<std::ptrdiff_t>(range.end));
    longest.interval = (time[range.end - 1] - time[range.begin]) /
                       static_cast<double>(range.size() - 1);
  }
  return longest;
}

std::optional<NoiseCoefficients> coefficients(const Evidence& evidence) {
  const RestSeries series = rest_series(evidence);
  if (series.residual.empty()) return std::nullopt;
  const std::vector<double> taus =
      octave_taus(series.residual.size(), series.interval);
  const std::vector<AllanPoint> points =
      allan_curve(series.residual, series.interval, taus).overlapping;
  if (!has_noise_coefficients(points)) return std::nullopt;
  return noise_coefficients(points);
}

std::optional<Estimate> coefficient(
    const Evidence& evidence,
    std::optional<CoefficientEstimate> NoiseCoefficients::*term,
    double per_hour) {
  const auto all = coefficients(evidence);
  if (!all || !((*all).*term)) return std::nullopt;
  const CoefficientEstimate found = *((*all).*term);
  return Estimate{
      per_hour * found.value,
      Interval{per_hour * found.interval.low, per_hour * found.interval.high}};
}

std::optional<Estimate> lowest_allan_deviation(const Evidence& evidence) {
  const auto all = coefficients(evidence);
  if (!all) return std::nullopt;
  const AllanPoint& lowest = all->lowest;
  const double unit =
      kHour / std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
  return Estimate{
      unit * lowest.deviation,
      Interval{unit * lowest.interval.low, unit * lowest.interval.high}};
}

std::optional<Estimate> white_noise_ratio(const Evidence& evidence) {
  std::optional<Estimate> farthest;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRest})) {
    const std::optional<AllanRatio> found =
        allan_ratio(*run->recording, run->rate);
    if (!found || found->seconds < kLeastSeconds ||
        !(found->fall <= kWhiteNoiseFall))
      continue;
    if (!farthest ||
        std::abs(std::log(found->ratio)) >= std::abs(std::log(farthest->value)))
      farthest = Estimate{found->ratio, found->interval};
  }
  return farthest;
}

}  // namespace

std::vector<Metric> noise_metrics() {
  using enum RunPurpose;
  return {
      {"angle_random_walk_deg_per_sqrt_h",
       "Angle random walk",
       "deg/sqrt(h)",
       "12.11",
       "N, white noise, of the fit sigma^2(tau) = 3 Q^2/tau^2 + N^2/tau + "
       "(2 ln 2/pi) B^2 + K^2 tau/3 + R^2 tau^2/2 to the overlapping Allan "
       "deviations.",
       {kRest},
       given(coefficient, &NoiseCoefficients::angle_random_walk,
             std::sqrt(kHour))},
      {"bias_instability_deg_per_h",
       "Bias instability",
       "deg/h",
       "12.11",
       "B, flicker, of the fit of angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       given(coefficient, &NoiseCoefficients::bias_instability, kHour)},
      {"rate_random_walk_deg_per_h_per_sqrt_h",
       "Rate random walk",
       "deg/h/sqrt(h)",
       "12.11",
       "K, random walk of the rate, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       given(coefficient, &NoiseCoefficients::rate_random_walk,
             kHour * std::sqrt(kHour))},
      {"rate_ramp_deg_per_h_per_h",
       "Rate ramp",
       "deg/h/h",
       "12.11",
       "R, steady change of the rate, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       given(coefficient, &NoiseCoefficients::rate_ramp, kHour * kHour)},
      {"quantisation_deg",
       "Quantisation",
       "deg",
       "12.11",
       "Q, rounding of the angle, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       given(coefficient, &NoiseCoefficients::angle_quantisation, 1.0)},
      {"bias_instability_bound_deg_per_h",
       "Upper bound of the bias instability",
       "deg/h",
       "12.11",
       "Lowest overlapping Allan deviation over sqrt(2 ln 2/pi) = "
       "0.664: the bias instability, or what lies above it.",
       {kRest},
       lowest_allan_deviation},
      {"white_noise_ratio",
       "White noise ratio",
       "1",
       "",
       "Allan deviation at 1 s of the judged residual over that of the "
       "recorded one. Below 1: noise was removed, and rate with it.",
       {kRest},
       white_noise_ratio,
       1.0},
  };
}

}  // namespace beamgyro::internal
