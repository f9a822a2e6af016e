// SPDX-License-Identifier: MIT
#include "dataset/log/log_statistics.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {
namespace {

class BurstCheck {
 public:
  BurstCheck(std::span<const double> values, const OutlierRule& rule)
      : values_(values), rule_(rule), resolution_(smallest_step(values)) {}

  bool is_outlier(std::size_t row, std::size_t begin, std::size_t end) {
    if (!std::isfinite(values_[row])) return false;
    const std::size_t size = std::min(rule_.window, end - begin);
    const std::size_t first = std::min(
        std::max(row, begin + rule_.window / 2) - rule_.window / 2, end - size);
    near_.clear();
    for (std::size_t k = first; k < first + size; ++k)
      if (std::isfinite(values_[k])) near_.push_back(values_[k]);
    const double median = median_of(near_);
    for (double& value : near_) value = std::abs(value - median);
    const double spread =
        std::max(kSigmaPerMad * median_of(near_), resolution_);
    return std::abs(values_[row] - median) > rule_.k * spread;
  }

 private:
  std::span<const double> values_;
  OutlierRule rule_;
  double resolution_;
  std::vector<double> near_;
};

}  // namespace

double median_of(std::vector<double>& values) {
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

double median_step(std::span<const double> time) {
  if (time.size() < 2) return 0.0;
  std::vector<double> steps(time.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k] = time[k + 1] - time[k];
  return median_of(steps);
}

std::vector<std::size_t> burst_starts(std::span<const double> time) {
  const double gap = kGapSteps * median_step(time);
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < time.size(); ++k)
    if (k == 0 || time[k] - time[k - 1] > gap) starts.push_back(k);
  return starts;
}

double smallest_step(std::span<const double> values) {
  double smallest = 0.0, last = std::nan("");
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double step = std::abs(value - last);
    if (step > 0.0 && (smallest == 0.0 || step < smallest)) smallest = step;
    last = value;
  }
  return smallest;
}

std::vector<bool> find_outliers(std::span<const double> time,
                                std::span<const double> values,
                                const OutlierRule& rule) {
  std::vector<bool> found(values.size(), false);
  BurstCheck check(values, rule);
  std::vector<std::size_t> edges = burst_starts(time);
  edges.push_back(values.size());
  for (std::size_t burst = 0; burst + 1 < edges.size(); ++burst)
    for (std::size_t k = edges[burst]; k < edges[burst + 1]; ++k)
      found[k] = check.is_outlier(k, edges[burst], edges[burst + 1]);
  return found;
}

Sampling sampling_of(const Recording& recording) {
  const std::vector<double>& time = recording.time;
  Sampling sampling;
  sampling.median_step = median_step(time);
  std::vector<std::size_t> edges = burst_starts(time);
  sampling.bursts = edges.size();
  edges.push_back(time.size());
  double squares = 0.0, steps = 0.0;
  for (std::size_t b = 0; b < sampling.bursts; ++b) {
    const std::size_t begin = edges[b], end = edges[b + 1];
    if (begin > 0)
      sampling.longest_gap =
          std::max(sampling.longest_gap, time[begin] - time[begin - 1]);
    sampling.longest_burst =
        std::max(sampling.longest_burst, time[end - 1] - time[begin]);
    for (std::size_t k = begin + 1; k < end; ++k) {
      const double off = time[k] - time[k - 1] - sampling.median_step;
      squares += off * off;
      steps += 1.0;
    }
  }
  sampling.jitter = steps > 0.0 ? std::sqrt(squares / steps) : 0.0;
  return sampling;
}

ValueRange range_of(const Recording& recording, std::string_view column) {
  const std::vector<double>& values = column_values(recording, column);
  ValueRange range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = range.samples > 0 ? std::min(range.low, value) : value;
    range.high = range.samples > 0 ? std::max(range.high, value) : value;
    ++range.samples;
  }
  range.smallest_step = smallest_step(values);
  return range;
}

}  // namespace beamgyro::internal
