// SPDX-License-Identifier: MIT
#include "dataset/log/log_report.h"

#include <algorithm>
#include <cmath>

#include "dataset/log/log_outliers.h"

namespace beamgyro::internal {

const char* reason_name(DropReason reason) {
  constexpr std::array<const char*, kDropReasons> kNames = {
      "filtered out",
      "wrong number of cells",
      "missing values",
      "duplicate times",
      "backward times",
      "outliers of the rate",
      "outliers of the temperature",
      "outside time.from and time.to",
      "without a value of the joined log"};
  return kNames[static_cast<std::size_t>(reason)];
}

void LogCounts::drop(DropReason reason, std::size_t line) {
  DroppedRows& rows_of = dropped[static_cast<std::size_t>(reason)];
  if (rows_of.rows == 0 || line < rows_of.first_line) rows_of.first_line = line;
  ++rows_of.rows;
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
