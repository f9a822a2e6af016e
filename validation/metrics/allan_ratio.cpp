// SPDX-License-Identifier: MIT
#include "validation/metrics/allan_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "compensation/scoring/allan_deviation.h"

namespace beamgyro::internal {
namespace {

constexpr double kStepTolerance = 1e-3;  // [-]
constexpr std::size_t kPieces = 20;

using Series = std::vector<double>;

/// Appends the squares of the differences between means of `m` samples and the
/// next ones, overlapping. Those of equal values are exactly zero.
void append_squares(const Series& values, std::size_t m, Series& squares) {
  const auto count = static_cast<double>(m);
  double difference = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    difference += values[k] - values[0];
    if (k >= m) difference -= 2.0 * (values[k - m] - values[0]);
    if (k >= 2 * m) difference += values[k - 2 * m] - values[0];
    if (k + 1 >= 2 * m) squares.push_back(std::pow(difference / count, 2));
  }
}

double sum_of(const Series& values, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += values[k];
  return sum;
}

/// Half the 95 % interval of the logarithm of the ratio of deviations.
double half_interval(const Series& judged, const Series& recorded) {
  Series without(kPieces);
  const double all_judged = sum_of(judged, 0, judged.size());
  const double all_recorded = sum_of(recorded, 0, recorded.size());
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < kPieces; ++i) {
    const std::size_t begin = i * judged.size() / kPieces;
    const std::size_t end = (i + 1) * judged.size() / kPieces;
    without[i] = 0.5 * std::log((all_judged - sum_of(judged, begin, end)) /
                                (all_recorded - sum_of(recorded, begin, end)));
    mean += without[i] / static_cast<double>(kPieces);
  }
  for (const double each : without) squares += std::pow(each - mean, 2);
  constexpr double kFreedom = kPieces - 1.0;
  return student_half_width(kFreedom) * std::sqrt(squares * kFreedom / kPieces);
}

}  // namespace

std::optional<AllanRatio> allan_ratio(const Recording& recording,
                                      std::span<const double> answers,
                                      std::ptrdiff_t lag) {
  const double step = usual_step(recording);
  const double samples = step > 0.0 ? std::round(1.0 / step) : 0.0;
  if (samples < 1.0 || std::abs(samples * step - 1.0) > kStepTolerance)
    return std::nullopt;
  const auto m = static_cast<std::size_t>(samples);
  const auto& rate = column_values(recording, "rate");
  const auto& truth = column_values(recording, "true_rate");
  Series judged, recorded, slow;
  std::size_t seconds = 0;
  for (const SampleRange& range : gapless_ranges(recording, answers)) {
    const auto first = static_cast<std::ptrdiff_t>(range.begin);
    const auto last = static_cast<std::ptrdiff_t>(range.end) - 1;
    Series before, after;
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto at =
          std::clamp(static_cast<std::ptrdiff_t>(k) + lag, first, last);
      before.push_back(rate[k] - truth[k]);
      after.push_back(answers[static_cast<std::size_t>(at)] - truth[k]);
    }
    append_squares(before, m, recorded);
    append_squares(after, m, judged);
    append_squares(before, 4 * m, slow);
    seconds += range.size() / m;
  }
  const auto mean_square = [](const Series& squares) {
    return sum_of(squares, 0, squares.size()) /
           static_cast<double>(squares.size());
  };
  const double noise = mean_square(recorded);
  if (!(noise > 0.0)) return std::nullopt;
  const double ratio = std::sqrt(mean_square(judged) / noise);
  AllanRatio result{ratio,
                    {ratio, ratio},
                    std::sqrt(0.5 * noise),
                    std::sqrt(mean_square(slow) / noise),
                    seconds};
  if (!(ratio > 0.0)) return result;
  const double factor = std::exp(half_interval(judged, recorded));
  result.interval =
      std::isfinite(factor)
          ? Interval{ratio / factor, ratio * factor}
          : Interval{0.0, std::numeric_limits<double>::infinity()};
  return result;
}

}  // namespace beamgyro::internal
