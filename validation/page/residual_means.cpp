// SPDX-License-Identifier: MIT
#include "validation/page/residual_means.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/inputs/sample_ranges.h"
#include "validation/page/figures.h"

namespace beamgyro {
namespace {

constexpr double kSoakBlock = 60.0;              // [s]
constexpr std::size_t kSettledBlocks = 10;       // ten minutes
constexpr double kSettledTemperatureMove = 0.2;  // [K], within them
constexpr double kSameSoak = 1.0;                // [K]

/// Number of the power-on that a sample belongs to.
std::size_t stretch_of(const std::vector<SampleRange>& stretches,
                       std::size_t sample) {
  const auto after =
      std::ranges::upper_bound(stretches, sample, {}, &SampleRange::begin);
  return static_cast<std::size_t>(after - stretches.begin()) - 1;
}

}  // namespace

double block_for_figure(const EvidenceRun& run, double least) {
  const auto& time = run.recording->time;
  if (time.empty()) return least;
  return std::max(least, std::ceil((time.back() - time.front()) /
                                   static_cast<double>(kFigurePoints)));
}

std::vector<double> residuals(const EvidenceRun& run) {
  const auto& truth = column_values(*run.recording, "true_rate");
  if (run.rate.size() != run.recording->time.size())
    throw std::invalid_argument(
        fmt::format("{}: {} rates for {} times, must be one each", run.name,
                    run.rate.size(), run.recording->time.size()));
  std::vector<double> residual(run.rate.size());
  std::ranges::transform(run.rate, truth, residual.begin(), std::minus<>());
  return residual;
}

std::vector<ResidualMean> residual_means(const EvidenceRun& run,
                                         double length) {
  const Recording& recording = *run.recording;
  const std::vector<double> residual = residuals(run);
  const auto& temperature = column_values(recording, "temperature");
  const auto stretches = powered_stretches(recording);
  std::vector<ResidualMean> means;
  for (const SampleRange& block : score_blocks(recording, length)) {
    double sum = 0.0, warmth = 0.0, count = 0.0;
    for (std::size_t k = block.begin; k < block.end; ++k)
      if (std::isfinite(residual[k]) && std::isfinite(temperature[k])) {
        sum += residual[k];
        warmth += temperature[k];
        count += 1.0;
      }
    if (count == 0.0) continue;
    const std::size_t power_on = stretch_of(stretches, block.begin);
    const double middle =
        0.5 * (recording.time[block.begin] + recording.time[block.end - 1]);
    means.push_back({middle - recording.time[stretches[power_on].begin],
                     warmth / count, sum / count, power_on});
  }
  return means;
}

std::vector<SettledSoak> settled_soaks(const EvidenceRun& run) {
  const std::vector<ResidualMean> blocks = residual_means(run, kSoakBlock);
  std::vector<SettledSoak> soaks;
  const auto settled = [&](std::size_t k) {
    return k + 1 >= kSettledBlocks && k < blocks.size() &&
           std::abs(blocks[k].temperature -
                    blocks[k + 1 - kSettledBlocks].temperature) <
               kSettledTemperatureMove;
  };
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (!settled(k) || settled(k + 1)) continue;
    SettledSoak soak{0.0, 0.0, true};
    for (std::size_t j = k + 1 - kSettledBlocks; j <= k; ++j) {
      soak.temperature += blocks[j].temperature / kSettledBlocks;
      soak.residual += blocks[j].residual / kSettledBlocks;
    }
    // A temperature that moves on within a soak ends it late.
    if (!soaks.empty() &&
        std::abs(soak.temperature - soaks.back().temperature) < kSameSoak)
      soaks.pop_back();
    if (!soaks.empty())
      soak.rising = soak.temperature > soaks.back().temperature;
    soaks.push_back(soak);
  }
  if (soaks.size() > 1) soaks.front().rising = soaks[1].rising;
  return soaks;
}

}  // namespace beamgyro
