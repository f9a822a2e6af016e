// SPDX-License-Identifier: MIT
#include "compensation/inputs/sample_ranges.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

std::vector<SampleRange> blocks_of(const std::vector<double>& time,
                                   const SampleRange& stretch, double step,
                                   double length) {
  std::vector<SampleRange> blocks;
  std::size_t fullest = 0;
  // Half a step keeps t = 60 s in block 1 however the time axis was rounded.
  const double origin = time[stretch.begin] - 0.5 * step;
  for (std::size_t begin = stretch.begin; begin < stretch.end;) {
    const double number = std::floor((time[begin] - origin) / length);
    std::size_t end = begin + 1;
    while (end < stretch.end &&
           std::floor((time[end] - origin) / length) == number)
      ++end;
    blocks.push_back({begin, end});
    fullest = std::max(fullest, end - begin);
    begin = end;
  }
  // A stretch that is short or sampled in bursts fills no block.
  const double least =
      0.5 * std::min(length, static_cast<double>(fullest) * step);  // [s]
  std::erase_if(blocks, [&](const SampleRange& block) {
    return static_cast<double>(block.size()) * step < least;
  });
  return blocks;
}

}  // namespace

double usual_step(const Recording& recording) {
  const auto& time = recording.time;
  if (time.size() < 2) return 0.0;
  std::vector<double> steps(time.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k] = time[k + 1] - time[k];
  const auto middle =
      steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::vector<SampleRange> powered_stretches(const Recording& recording) {
  const auto& status = recording.status;
  if (status.size() != recording.time.size())
    throw std::invalid_argument(
        fmt::format("status: {} entries for {} times, must be one each",
                    status.size(), recording.time.size()));
  std::vector<SampleRange> stretches;
  bool on = false;
  for (std::size_t k = 0; k < status.size(); ++k) {
    const bool powered = (status[k] & kUnpowered) == 0;
    if (powered && !on) stretches.push_back({k, k});
    if (powered) stretches.back().end = k + 1;
    on = powered;
  }
  return stretches;
}

std::vector<SampleRange> score_blocks(const Recording& recording,
                                      double length) {
  if (!(length > 0.0) || !std::isfinite(length))
    throw std::invalid_argument(
        fmt::format("block length: {} s, must be positive", length));
  const double step = usual_step(recording);
  std::vector<SampleRange> blocks;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    const auto found = blocks_of(recording.time, stretch, step, length);
    blocks.insert(blocks.end(), found.begin(), found.end());
  }
  return blocks;
}

std::vector<SampleRange> temperature_plateaus(const Recording& recording) {
  std::vector<SampleRange> stretches = powered_stretches(recording);
  const Column* temperature = find_column(recording, "temperature");
  if (temperature == nullptr) return stretches;
  std::vector<SampleRange> plateaus;
  for (const SampleRange& stretch : stretches) {
    double first = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const double here = temperature->values[k];
      if (!(std::abs(here - first) < kPlateauTolerance)) {
        plateaus.push_back({k, k});
        first = here;
      }
      plateaus.back().end = k + 1;
    }
  }
  return plateaus;
}

}  // namespace beamgyro::internal
