// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <numbers>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "validation/metrics/evaluations.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal::evaluation {
namespace {

constexpr double kHour = 3600.0;  // [s]
constexpr std::size_t kLeastRestSamples = 64;
constexpr double kPieces = 20.0;  // of a run, for the interval of a ratio

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
      oadev(series.residual, series.interval, taus);
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

/// Sums of squared differences of neighbouring means of 1 s, of each piece.
struct DifferenceSums {
  std::vector<double> judged, recorded;
};

DifferenceSums difference_sums(const EvidenceRun& run) {
  const Recording& recording = *run.recording;
  const SampleRange range = longest_gapless_range(recording, run.rate);
  const auto second =
      static_cast<std::size_t>(std::round(1.0 / usual_step(recording)));
  const auto& raw = column_values(recording, "rate");
  const auto& truth = column_values(recording, "true_rate");
  const std::size_t seconds = range.size() / second;
  DifferenceSums sums{std::vector<double>(static_cast<std::size_t>(kPieces)),
                      std::vector<double>(static_cast<std::size_t>(kPieces))};
  std::array<double, 2> last{};
  for (std::size_t i = 0; i < seconds; ++i) {
    std::array<double, 2> mean{};
    for (std::size_t j = 0; j < second; ++j) {
      const std::size_t k = range.begin + i * second + j;
      mean[0] += (run.rate[k] - truth[k]) / static_cast<double>(second);
      mean[1] += (raw[k] - truth[k]) / static_cast<double>(second);
    }
    const std::size_t piece = i * sums.judged.size() / seconds;
    if (i > 0) {
      sums.judged[piece] += std::pow(mean[0] - last[0], 2);
      sums.recorded[piece] += std::pow(mean[1] - last[1], 2);
    }
    last = mean;
  }
  return sums;
}

/// 95 % interval of the logarithm of the root of a ratio of sums, as half its
/// width: the jackknife over pieces with Student's t.
double half_interval_of_ratio(const DifferenceSums& sums) {
  const auto ratio = [&](std::size_t without) {
    double judged = 0.0, recorded = 0.0;
    for (std::size_t i = 0; i < sums.judged.size(); ++i) {
      if (i == without) continue;
      judged += sums.judged[i];
      recorded += sums.recorded[i];
    }
    return 0.5 * std::log(judged / recorded);
  };
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < sums.judged.size(); ++i)
    mean += ratio(i) / kPieces;
  for (std::size_t i = 0; i < sums.judged.size(); ++i)
    squares += std::pow(ratio(i) - mean, 2);
  return student_half_width(kPieces - 1.0) *
         std::sqrt(squares * (kPieces - 1.0) / kPieces);
}

constexpr double kWhiteNoiseFall = 0.75;  // [-], deviation at 4 s over 1 s
constexpr double kShortestSeries = 10.0;  // [s]
constexpr double kStepTolerance = 1e-3;   // [-]

// The Allan deviation at 1 s of the judged residual over that of the recorded
// one, in the longest gapless stretch. Returns nothing where the recorded one
// has no white noise at 1 s (its deviation falls to 0.5 at 4 s), where 1 s is
// no multiple of the step, and for less than kShortestSeries.
std::optional<double> ratio_at_1_s(const EvidenceRun& run) {
  const auto& rate = column_values(*run.recording, "rate");
  const auto& truth = column_values(*run.recording, "true_rate");
  const SampleRange range = longest_gapless_range(*run.recording, run.rate);
  std::vector<double> before, after;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    before.push_back(rate[k] - truth[k]);
    after.push_back(run.rate[k] - truth[k]);
  }
  const double step = usual_step(*run.recording);
  const double samples = step > 0.0 ? std::round(1.0 / step) : 0.0;
  const bool whole = std::abs(samples * step - 1.0) < kStepTolerance;
  if (samples < 1.0 || !whole ||
      static_cast<double>(range.size()) < samples * kShortestSeries)
    return std::nullopt;
  const std::array taus{1.0, 4.0};
  const auto raw = oadev(before, 1.0 / samples, taus);
  if (!(raw[1].deviation <= kWhiteNoiseFall * raw[0].deviation))
    return std::nullopt;
  return oadev(after, 1.0 / samples, taus)[0].deviation / raw[0].deviation;
}

}  // namespace

std::optional<Estimate> angle_random_walk(const Evidence& evidence) {
  return coefficient(evidence, &NoiseCoefficients::angle_random_walk,
                     std::sqrt(kHour));
}

std::optional<Estimate> bias_instability(const Evidence& evidence) {
  return coefficient(evidence, &NoiseCoefficients::bias_instability, kHour);
}

std::optional<Estimate> rate_random_walk(const Evidence& evidence) {
  return coefficient(evidence, &NoiseCoefficients::rate_random_walk,
                     kHour * std::sqrt(kHour));
}

std::optional<Estimate> rate_ramp(const Evidence& evidence) {
  return coefficient(evidence, &NoiseCoefficients::rate_ramp, kHour * kHour);
}

std::optional<Estimate> quantisation(const Evidence& evidence) {
  return coefficient(evidence, &NoiseCoefficients::angle_quantisation, 1.0);
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
    const std::optional<double> ratio = ratio_at_1_s(*run);
    if (!ratio) continue;
    const bool farther = !farthest || std::abs(std::log(*ratio)) >
                                          std::abs(std::log(farthest->value));
    if (!farther) continue;
    const double factor =
        *ratio > 0.0 ? std::exp(half_interval_of_ratio(difference_sums(*run)))
                     : 1.0;
    farthest = Estimate{*ratio, Interval{*ratio / factor, *ratio * factor}};
  }
  return farthest;
}

}  // namespace beamgyro::internal::evaluation
