// SPDX-License-Identifier: MIT
#include "validation/metrics/soaks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

constexpr double kLeastSoak = 600.0;    // [s]
constexpr double kSoakAverage = 300.0;  // [s], at its end
constexpr double kMeasuredHold = 0.05;  // [K], in a minute

/// Ranges of constant ambient temperature, or in a recording without one those
/// whose measured temperature no longer moves from minute to minute.
std::vector<SampleRange> constant_temperature(const Recording& recording) {
  if (const Column* ambient =
          find_column(recording, "true_ambient_temperature"))
    return held_ranges(recording, std::array{&ambient->values});
  std::vector<SampleRange> ranges;
  double last = NAN;
  for (const Segment& block : segments_of(recording, score_blocks(recording))) {
    const bool held = std::abs(block.temperature - last) < kMeasuredHold;
    if (!held || ranges.empty()) ranges.push_back(block.samples);
    ranges.back().end = block.samples.end;
    last = block.temperature;
  }
  return ranges;
}

}  // namespace

std::vector<Soak> soaks_of(const Recording& recording) {
  const Column* ambient = find_column(recording, "true_ambient_temperature");
  const Column* measured = find_column(recording, "temperature");
  if (ambient == nullptr) ambient = measured;
  const double step = usual_step(recording);
  std::vector<Soak> soaks;
  for (SampleRange range : constant_temperature(recording)) {
    const double length = static_cast<double>(range.size()) * step;
    if (ambient == nullptr || length < kLeastSoak) continue;
    const auto average = static_cast<std::size_t>(
        std::max(1.0, std::round(kSoakAverage / step)));
    range.begin = range.end - std::min(average, range.size());
    Soak soak{range, ambient->values[range.end - 1]};
    if (!soaks.empty())
      soak.reached = soak.ambient > soaks.back().ambient ? Direction::kUp
                                                         : Direction::kDown;
    soaks.push_back(soak);
  }
  return soaks;
}

std::vector<SampleRange> ranges_of(const std::vector<Soak>& soaks) {
  std::vector<SampleRange> ranges;
  for (const Soak& soak : soaks) ranges.push_back(soak.range);
  return ranges;
}

}  // namespace beamgyro::internal
