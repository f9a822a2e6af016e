// SPDX-License-Identifier: MIT
#include "validation/metrics/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"
#include "linear_algebra/least_squares.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

constexpr int kFirstNeighbour = 2, kLastNeighbour = 6;
constexpr double kLeastRest = 0.5;    // [s], before a step
constexpr double kBeforeJump = 0.05;  // [s], mean before the step
constexpr double kAfterJump = 0.5;    // [s], at most
constexpr double kEndOfJump = 0.2;    // [-], of the time after the step
constexpr double kLeastJump = 0.1;    // [deg/s]
constexpr int kRefinements = 3;
constexpr int kPerOctave = 24;
constexpr double kLowestOfStep = 1.0;  // [Hz]
constexpr double kHighest = 0.8;       // [-], of the Nyquist frequency

/// Times at which a signal rises through `middle`.
std::vector<double> rises(const Recording& recording,
                          std::span<const double> signal,
                          const SampleRange& range, double middle) {
  std::vector<double> times;
  for (std::size_t k = range.begin + 1; k < range.end; ++k) {
    const double before = signal[k - 1] - middle, now = signal[k] - middle;
    if (before < 0.0 && now >= 0.0)
      times.push_back(recording.time[k - 1] +
                      (recording.time[k] - recording.time[k - 1]) * before /
                          (before - now));
  }
  return times;
}

/// The frequency [Hz] of a sine over a range, or 0.
double true_sine_frequency(const Recording& recording,
                           std::span<const double> signal,
                           const SampleRange& range) {
  const auto values = signal.subspan(range.begin, range.size());
  const auto [low, high] = std::ranges::minmax(values);
  const auto times = rises(recording, signal, range, 0.5 * (low + high));
  if (times.size() < 2 || !(high > low)) return 0.0;
  return static_cast<double>(times.size() - 1) / (times.back() - times.front());
}

struct SineFit {
  std::complex<double> amplitude;  // of Re[amplitude e^(i omega t)]
  Eigen::VectorXd left;            // what the fit leaves
};

SineFit fit_sine(std::span<const double> time, std::span<const double> signal,
                 double omega) {
  const auto rows = static_cast<Eigen::Index>(time.size());
  Eigen::MatrixXd terms(rows, 4);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double t = time[static_cast<std::size_t>(k)] - time[0];
    terms.row(k) << 1.0, t, std::cos(omega * t), std::sin(omega * t);
  }
  const Eigen::Map<const Eigen::VectorXd> values(signal.data(), rows);
  const Eigen::VectorXd found = least_squares(terms, values).x;
  return {{found(2), -found(3)}, values - terms * found};
}

/// How far a sine is from a frequency [Hz], by the phases of its two halves.
double frequency_error(std::span<const double> time,
                       std::span<const double> signal, double frequency) {
  const std::size_t half = time.size() / 2;
  const double omega = 2.0 * std::numbers::pi * frequency;
  const auto phase = [&](std::size_t from) {
    const SineFit fit =
        fit_sine(time.subspan(from, half), signal.subspan(from, half), omega);
    return std::arg(fit.amplitude * std::polar(1.0, -omega * time[from]));
  };
  return std::remainder(phase(half) - phase(0), 2.0 * std::numbers::pi) /
         (2.0 * std::numbers::pi * (time[half] - time[0]));
}

std::complex<double> amplitude_at(const Eigen::VectorXd& left,
                                  std::span<const double> time, double omega) {
  std::complex<double> sum = 0.0;
  for (Eigen::Index k = 0; k < left.size(); ++k)
    sum +=
        left(k) *
        std::polar(1.0, -omega * (time[static_cast<std::size_t>(k)] - time[0]));
  return 2.0 * sum / static_cast<double>(left.size());
}

/// The powered samples of a run from kSettlingTime after its last power-on.
SampleRange settled_samples(const Recording& recording) {
  SampleRange range = powered_stretches(recording).back();
  const double from = recording.time[range.begin] + kSettlingTime;
  while (range.begin < range.end && recording.time[range.begin] < from)
    ++range.begin;
  return range;
}

/// The jump of true_rate that step_response() looks for: first sample after it.
std::optional<std::size_t> jump_of(const Recording& recording,
                                   const std::vector<double>& truth) {
  for (const SampleRange& stretch : powered_stretches(recording))
    for (std::size_t k = stretch.begin + 1; k < stretch.end; ++k)
      if (std::abs(truth[k] - truth[k - 1]) >= kLeastJump)
        return recording.time[k] - recording.time[stretch.begin] >= kLeastRest
                   ? std::optional(k)
                   : std::nullopt;
  return std::nullopt;
}

}  // namespace

std::optional<ResponsePoint> sine_response(const Recording& recording,
                                           std::span<const double> input,
                                           std::span<const double> output) {
  if (powered_stretches(recording).empty()) return std::nullopt;
  const auto& truth = column_values(recording, "true_rate");
  SampleRange range = settled_samples(recording);
  if (range.size() < 8) return std::nullopt;
  double frequency = true_sine_frequency(recording, truth, range);
  if (!(frequency > 0.0)) return std::nullopt;
  for (int i = 0; i < kRefinements; ++i)
    frequency += frequency_error(
        std::span(recording.time).subspan(range.begin, range.size()),
        std::span(truth).subspan(range.begin, range.size()), frequency);
  const double step = usual_step(recording);
  const double all = static_cast<double>(range.size()) * step;
  // Half a step more than whole periods are in the range.
  const double periods = std::floor(all * frequency + 0.5 * step * frequency);
  if (!(periods >= 1.0)) return std::nullopt;
  const auto samples = static_cast<std::size_t>(
      std::min(static_cast<double>(range.size()),
               std::round(periods / (frequency * step))));
  range.begin = range.end - samples;
  const double omega = 2.0 * std::numbers::pi * frequency;
  const std::span time =
      std::span(recording.time).subspan(range.begin, samples);
  const SineFit in = fit_sine(time, input.subspan(range.begin, samples), omega);
  const SineFit out =
      fit_sine(time, output.subspan(range.begin, samples), omega);
  const std::complex<double> gain = out.amplitude / in.amplitude;
  // What the input shows beside the sine reaches the output, too.
  const Eigen::VectorXd left = out.left - std::abs(gain) * in.left;
  const double length = static_cast<double>(samples) * step;
  double power = 0.0, neighbours = 0.0;
  for (int k = kFirstNeighbour; k <= kLastNeighbour; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const double beside = frequency + sign * k / length;
      if (beside < 1.0 / length || beside > 0.5 / step) continue;
      power +=
          std::norm(amplitude_at(left, time, 2.0 * std::numbers::pi * beside));
      neighbours += 1.0;
    }
  const double sigma = neighbours > 0.0 ? std::sqrt(0.5 * power / neighbours) /
                                              std::abs(in.amplitude)
                                        : 0.0;
  return ResponsePoint{frequency, gain, sigma, 2.0 * neighbours};
}

std::vector<ResponsePoint> sine_responses(const Evidence& evidence,
                                          std::string_view input) {
  std::vector<ResponsePoint> points;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kSineRate}))
    if (const auto point = sine_response(
            *run->recording, column_values(*run->recording, input), run->rate))
      points.push_back(*point);
  std::ranges::sort(points, {}, &ResponsePoint::frequency);
  return points;
}

std::vector<ResponsePoint> step_response(const Recording& recording,
                                         std::span<const double> output,
                                         std::span<const double> frequencies) {
  const auto& truth = column_values(recording, "true_rate");
  const auto jump = jump_of(recording, truth);
  if (!jump) return {};
  const double step = usual_step(recording);
  const auto samples = [step](double length) {
    return static_cast<std::size_t>(std::round(length / step));
  };
  std::size_t after = 1;
  while (*jump + after < truth.size() && after < samples(kAfterJump) &&
         truth[*jump + after] == truth[*jump])
    ++after;
  const auto end_part =
      static_cast<std::size_t>(kEndOfJump * static_cast<double>(after));
  const std::size_t before = samples(kBeforeJump);
  if (end_part < 2 || before < 2 || before > *jump) return {};
  const auto rest = output.subspan(*jump - before, before);
  const double start = mean_of(rest);
  const double height =
      mean_of(output.subspan(*jump + after - end_part, end_part)) - start;
  double variance = 0.0;
  for (const double value : rest)
    variance +=
        (value - start) * (value - start) / static_cast<double>(before - 1);
  std::vector<ResponsePoint> points;
  for (const double frequency : frequencies) {
    const double omega = 2.0 * std::numbers::pi * frequency;
    std::complex<double> sum = 0.0;
    for (std::size_t j = 0; j + 1 < after; ++j) {
      // The step happens between the last sample before and the first after.
      const std::size_t k = *jump - 1 + j;
      const double from = j == 0 ? start : output[k];
      sum += (output[k + 1] - from) *
             std::polar(1.0, -omega * static_cast<double>(j) * step);
    }
    const double half = 0.5 * omega * step;
    const double correction = half / std::sin(half);
    const double sigma =
        std::sqrt(0.5 * variance * static_cast<double>(after)) * 2.0 *
        std::sin(half) * correction / std::abs(height);
    points.push_back({frequency, sum * correction / height, sigma,
                      static_cast<double>(before - 1)});
  }
  return points;
}

std::vector<ResponsePoint> response_to_true_rate(const Evidence& evidence) {
  std::vector<ResponsePoint> points = sine_responses(evidence, "true_rate");
  const double highest = points.empty() ? 0.0 : points.back().frequency;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRateStep})) {
    std::vector<double> frequencies;
    const double nyquist = 0.5 / usual_step(*run->recording);
    for (int i = 0;; ++i) {
      const double f =
          kLowestOfStep * std::exp2(static_cast<double>(i) / kPerOctave);
      if (f > kHighest * nyquist) break;
      if (f > highest) frequencies.push_back(f);
    }
    const auto more = step_response(*run->recording, run->rate, frequencies);
    points.insert(points.end(), more.begin(), more.end());
    if (!more.empty()) break;
  }
  return points;
}

std::optional<Crossing> first_crossing(std::span<const ResponsePoint> points,
                                       std::span<const double> values,
                                       std::span<const double> sigmas,
                                       double common_sigma) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!(values[i - 1] >= 0.0 && values[i] < 0.0)) continue;
    const double share = values[i - 1] / (values[i - 1] - values[i]);
    const double octaves =
        std::log(points[i].frequency / points[i - 1].frequency);
    const double frequency =
        points[i - 1].frequency * std::exp(share * octaves);
    const double slope =
        (values[i - 1] - values[i]) / (octaves * frequency);  // per Hz
    const double sigma = std::hypot((1.0 - share) * sigmas[i - 1],
                                    share * sigmas[i], common_sigma);
    return Crossing{frequency, sigma / slope,
                    std::min(points[i - 1].freedom, points[i].freedom)};
  }
  return std::nullopt;
}

}  // namespace beamgyro::internal
