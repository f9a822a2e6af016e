// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "validation/metrics/frequency_response.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

constexpr double kHalfPower = 20.0 * 0.15051499783199057;  // [dB], 10 log10(2)
constexpr double kDecibels = 20.0 / std::numbers::ln10;  // [dB] in a unit of ln
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;  // [rad]
constexpr double kLongestDelay = 2.0;                    // [s], looked for
constexpr double kLeastSpread = 1e-15;                   // [rad]
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

Estimate with_t_interval(double value, double sigma, double freedom) {
  if (!(sigma > 0.0) || !(freedom >= 1.0))
    return {value, Interval{value, value}};
  const double half = student_half_width(freedom) * sigma;
  return {value, Interval{value - half, value + half}};
}

std::optional<Estimate> crossing_of(std::span<const ResponsePoint> points,
                                    std::span<const double> values,
                                    std::span<const double> sigmas,
                                    double common_sigma) {
  const auto found = first_crossing(points, values, sigmas, common_sigma);
  if (!found) return std::nullopt;
  return with_t_interval(found->frequency, found->sigma, found->freedom);
}

/// Phases [rad] by rising frequency, each within half a turn of a constant
/// delay through the one before.
std::vector<double> unwrapped(std::span<const ResponsePoint> points) {
  std::vector<double> phases;
  double expected = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0)
      expected = phases[i - 1] * points[i].frequency / points[i - 1].frequency;
    const double phase = std::arg(points[i].gain);
    const double turn = 2.0 * std::numbers::pi;
    phases.push_back(phase + turn * std::round((expected - phase) / turn));
  }
  return phases;
}

/// Delay [s] from phases over frequency, weighted by their certainty.
Estimate delay_of(std::span<const ResponsePoint> points) {
  const std::vector<double> phases = unwrapped(points);
  double sum = 0.0, weights = 0.0, freedom = HUGE_VAL;
  bool exact = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double omega = 2.0 * std::numbers::pi * points[i].frequency;
    const double spread = points[i].sigma / std::abs(points[i].gain);
    const double weight = std::pow(omega / std::max(spread, kLeastSpread), 2);
    exact = exact && !(spread > kLeastSpread);
    sum += weight * -phases[i] / omega;
    weights += weight;
    freedom = std::min(freedom, points[i].freedom);
  }
  // What rounding leaves of equal phases is no delay.
  const double delay = std::abs(sum / weights) < 1e-12 ? 0.0 : sum / weights;
  return with_t_interval(delay, exact ? 0.0 : 1.0 / std::sqrt(weights),
                         freedom);
}

double dot_shifted(std::span<const double> after,
                   std::span<const double> before, std::ptrdiff_t lag,
                   std::size_t margin) {
  double sum = 0.0;
  for (std::size_t k = margin; k + margin < after.size(); ++k)
    sum +=
        after[k] *
        before[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) - lag)];
  return sum;
}

void centre(std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values)
    mean += value / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
}

/// Delay of a run whose rate is no sine: the lag of the largest
/// cross-correlation, between samples by a parabola.
std::optional<Estimate> correlated_delay(const EvidenceRun& run) {
  const Recording& recording = *run.recording;
  const auto stretches = powered_stretches(recording);
  if (stretches.empty()) return std::nullopt;
  const SampleRange range = stretches.back();
  const auto& raw = column_values(recording, "rate");
  const auto part = [&](const std::vector<double>& all) {
    std::vector<double> values(
        all.begin() + static_cast<std::ptrdiff_t>(range.begin),
        all.begin() + static_cast<std::ptrdiff_t>(range.end));
    centre(values);
    return values;
  };
  const std::vector<double> after = part(run.rate), before = part(raw);
  const double step = usual_step(recording);
  const auto margin = static_cast<std::size_t>(
      std::min(kLongestDelay / step, 0.1 * static_cast<double>(range.size())));
  if (margin < 2) return std::nullopt;
  const auto reach = static_cast<std::ptrdiff_t>(margin) - 1;
  std::ptrdiff_t best = 0;
  std::vector<double> sums;
  for (std::ptrdiff_t lag = -reach; lag <= reach; ++lag) {
    sums.push_back(dot_shifted(after, before, lag, margin));
    if (sums.back() > sums[static_cast<std::size_t>(best)])
      best = static_cast<std::ptrdiff_t>(sums.size()) - 1;
  }
  if (best == 0 || best == 2 * reach) return std::nullopt;
  const auto b = static_cast<std::size_t>(best);
  const double bend = sums[b - 1] - 2.0 * sums[b] + sums[b + 1];
  const double peak = 0.5 * (sums[b - 1] - sums[b + 1]) / bend;
  const double delay = step * (static_cast<double>(best - reach) + peak);
  // What the shifted rate leaves, over the slopes that a delay would show.
  const double gain = sums[b] / dot_shifted(before, before, 0, margin);
  double left = 0.0, slopes = 0.0;
  for (std::size_t k = margin; k + margin < after.size(); ++k) {
    const std::size_t j =
        static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) - best + reach);
    const double slope = 0.5 * (before[j + 1] - before[j - 1]) / step;
    const double expected = gain * (before[j] - peak * step * slope);
    left += std::pow(after[k] - expected, 2);
    slopes += std::pow(gain * slope, 2);
  }
  const auto n = static_cast<double>(after.size() - 2 * margin);
  return with_t_interval(delay, std::sqrt(left / n / slopes), n - 2.0);
}

/// Levels [dB] over that at the lowest frequency, and their 1-sigma without
/// what all share, the noise at the lowest. None where the judged rate does not
/// answer at each frequency.
struct ResponseLevels {
  std::vector<ResponsePoint> points;
  std::vector<double> values, sigmas;
};

std::optional<ResponseLevels> levels_of(const Evidence& evidence) {
  ResponseLevels levels{response_to_true_rate(evidence), {}, {}};
  if (levels.points.size() < 2) return std::nullopt;
  const double lowest = std::abs(levels.points[0].gain);
  for (const ResponsePoint& point : levels.points) {
    levels.values.push_back(kDecibels *
                            std::log(std::abs(point.gain) / lowest));
    levels.sigmas.push_back(kDecibels * point.sigma / std::abs(point.gain));
  }
  if (!std::ranges::all_of(levels.values,
                           [](double level) { return std::isfinite(level); }))
    return std::nullopt;
  return levels;
}

std::optional<Estimate> bandwidth(const Evidence& evidence) {
  auto levels = levels_of(evidence);
  if (!levels) return std::nullopt;
  for (double& value : levels->values) value += kHalfPower;
  return crossing_of(levels->points, levels->values, levels->sigmas,
                     levels->sigmas[0]);
}

/// The highest level of a response, and where it is.
struct ResponsePeak {
  Estimate level;      // [dB]
  Estimate frequency;  // [Hz]
};

/// The upper end of a level is the highest of those of all points. The lower
/// end is that of all points that may be the highest at once (Bonferroni). The
/// frequencies are those of the points that reach it.
std::optional<ResponsePeak> peak_of(const Evidence& evidence) {
  const auto levels = levels_of(evidence);
  if (!levels) return std::nullopt;
  const std::vector<ResponsePoint>& points = levels->points;
  const std::vector<double>& values = levels->values;
  const std::vector<double>& sigmas = levels->sigmas;
  const auto half_of = [&](std::size_t i, std::size_t count) {
    const double sigma = i == 0 ? 0.0 : std::hypot(sigmas[i], sigmas[0]);
    return sigma > 0.0 ? sigma * student_half_width(
                                     std::max(1.0, points[i].freedom), count)
                       : 0.0;
  };
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(values) -
                                             values.begin());
  const auto lower_of = [&](std::size_t count) {
    double low = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
      low = std::max(low, values[i] - half_of(i, count));
    return low;
  };
  const auto may_reach = [&](double level) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (values[i] + half_of(i, 1) >= level) found.push_back(i);
    return found;
  };
  const double low = lower_of(may_reach(lower_of(1)).size());
  double high = values[peak];
  for (std::size_t i = 0; i < points.size(); ++i)
    high = std::max(high, values[i] + half_of(i, 1));
  const std::vector<std::size_t> there = may_reach(low);
  return ResponsePeak{
      {values[peak], Interval{low, high}},
      {points[peak].frequency, Interval{points[there.front()].frequency,
                                        points[there.back()].frequency}}};
}

std::optional<Estimate> response_peak(const Evidence& evidence) {
  const auto peak = peak_of(evidence);
  if (!peak) return std::nullopt;
  return peak->level;
}

std::optional<Estimate> response_peak_frequency(const Evidence& evidence) {
  const auto peak = peak_of(evidence);
  if (!peak || !(peak->level.value > 0.0)) return std::nullopt;
  return peak->frequency;
}

std::optional<Estimate> phase_lag_90(const Evidence& evidence) {
  const std::vector<ResponsePoint> points = response_to_true_rate(evidence);
  if (points.size() < 2) return std::nullopt;
  std::vector<double> values = unwrapped(points), sigmas;
  for (double& value : values) value += kQuarterTurn;
  for (const ResponsePoint& point : points)
    sigmas.push_back(point.sigma / std::abs(point.gain));
  return crossing_of(points, values, sigmas, 0.0);
}

std::optional<Estimate> added_delay(const Evidence& evidence) {
  const std::vector<ResponsePoint> points = sine_responses(evidence, "rate");
  if (!points.empty()) return delay_of(points);
  for (const EvidenceRun* run :
       runs_for(evidence, {RunPurpose::kRandomRate, RunPurpose::kRateStep}))
    if (const auto delay = correlated_delay(*run)) return delay;
  return std::nullopt;
}

}  // namespace

std::vector<Metric> response_metrics() {
  using enum RunPurpose;
  return {
      {"bandwidth_Hz",
       "Bandwidth",
       "Hz",
       "12.15",
       "Frequency at which |H(f)|, judged rate over true rate, falls 3 dB "
       "below its value at the lowest frequency.",
       {kSineRate, kRateStep, kRandomRate},
       bandwidth,
       kUnlimited},
      {"response_peak_dB",
       "Response peak",
       "dB",
       "12.15",
       "Highest |H(f)| over its value at the lowest frequency, 20 log10 of the "
       "quotient: 0 without a peak.",
       {kSineRate, kRateStep},
       response_peak},
      {"response_peak_Hz",
       "Frequency of the response peak",
       "Hz",
       "12.15",
       "Frequency at which |H(f)| is highest, where that is not the lowest.",
       {kSineRate, kRateStep},
       response_peak_frequency,
       kUnlimited},
      {"phase_lag_90_deg_Hz",
       "Frequency of 90° phase lag",
       "Hz",
       "12.15",
       "Frequency at which the phase of H(f) lags by 90 degrees.",
       {kSineRate, kRateStep, kRandomRate},
       phase_lag_90,
       kUnlimited},
      {"added_delay_s",
       "Added delay",
       "s",
       "",
       "Delay of the judged rate after the recorded rate, from the "
       "phase between them.",
       {kSineRate, kRateStep, kRandomRate},
       added_delay},
  };
}

}  // namespace beamgyro::internal
