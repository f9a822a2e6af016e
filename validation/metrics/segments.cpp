// SPDX-License-Identifier: MIT
#include "validation/metrics/segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamgyro::internal {
namespace {

double mean_over(const SampleRange& range, std::span<const double> values) {
  return mean_of(values.subspan(range.begin, range.size()));
}

}  // namespace

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::vector<Segment> segments_of(const Recording& recording,
                                 std::span<const SampleRange> ranges) {
  const std::vector<SampleRange> stretches = powered_stretches(recording);
  const Column* temperature = find_column(recording, "temperature");
  const double step = usual_step(recording);
  std::vector<Segment> segments;
  for (const SampleRange& range : ranges) {
    const auto stretch = std::ranges::find_if(
        stretches, [&](const SampleRange& s) { return range.begin < s.end; });
    const double time = mean_over(range, recording.time);
    segments.push_back(
        {.samples = range,
         .time = time,
         .length = static_cast<double>(range.size()) * step,
         .temperature = temperature != nullptr
                            ? mean_over(range, temperature->values)
                            : std::numeric_limits<double>::quiet_NaN(),
         .powered = time - recording.time[stretch->begin],
         .power_on = static_cast<std::size_t>(stretch - stretches.begin())});
  }
  return segments;
}

std::vector<double> residual_of(const EvidenceRun& run) {
  const auto& truth = column_values(*run.recording, "true_rate");
  std::vector<double> residual(truth.size());
  std::ranges::transform(run.rate, truth, residual.begin(), std::minus<>());
  return residual;
}

std::vector<double> means_over(std::span<const Segment> segments,
                               std::span<const double> values) {
  std::vector<double> means;
  for (const Segment& segment : segments)
    means.push_back(mean_over(segment.samples, values));
  return means;
}

std::vector<SampleRange> held_ranges(
    const Recording& recording,
    std::span<const std::vector<double>* const> columns) {
  std::vector<SampleRange> held;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    held.push_back({stretch.begin, stretch.begin});
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const bool same = std::ranges::all_of(columns, [&](const auto* column) {
        return std::abs((*column)[k] - (*column)[held.back().begin]) <=
               kNoTolerance;
      });
      if (!same) held.push_back({k, k});
      held.back().end = k + 1;
    }
  }
  return held;
}

SampleRange settled(const Recording& recording, SampleRange range,
                    double settling) {
  const double from =
      recording.time[range.begin] + settling - 0.5 * usual_step(recording);
  while (range.begin < range.end && recording.time[range.begin] < from)
    ++range.begin;
  return range;
}

}  // namespace beamgyro::internal
