// SPDX-License-Identifier: MIT
#include "validation/checks/temperature_sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {
namespace {

constexpr TemperatureRange kPlausible = {-100.0, 200.0};  // [degC]
constexpr double kRateChange = 0.01;                      // [deg/s]

double powered_mean(const Recording& recording,
                    const std::vector<double>& values) {
  double sum = 0.0, samples = 0.0;
  for (const SampleRange& stretch : powered_stretches(recording))
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      sum += values[k];
      samples += 1.0;
    }
  return sum / samples;
}

// Means and slope of one column over another, from its powered samples.
struct SweepLine {
  double y, x, slope;

  double at(double here) const { return y + slope * (here - x); }
};

SweepLine line_over(const Recording& recording, const std::vector<double>& x,
                    const std::vector<double>& y) {
  SweepLine line{powered_mean(recording, y), powered_mean(recording, x), 0.0};
  double variance = 0.0, covariance = 0.0;
  for (const SampleRange& stretch : powered_stretches(recording))
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      variance += (x[k] - line.x) * (x[k] - line.x);
      covariance += (x[k] - line.x) * (y[k] - line.y);
    }
  if (variance > 0.0) line.slope = covariance / variance;
  return line;
}

}  // namespace

Recording temperature_sweep(const Recording& recording,
                            const TemperatureRange& range, double period) {
  const double lowest = std::max(range.lowest, kPlausible.lowest);
  const double highest =
      std::max(lowest, std::min(range.highest, kPlausible.highest));
  const auto steps =
      static_cast<std::size_t>(std::floor((highest - lowest) / kSweepStep)) + 1;
  const std::size_t samples = 2 * steps + 1;
  const auto& rate = column_values(recording, "rate");
  const double at_rest =
      powered_mean(recording, rate) -
      powered_mean(recording, column_values(recording, "true_rate"));
  Recording sweep;
  std::vector<double> swept_rate, temperature;
  for (std::size_t k = 0; k < samples; ++k) {
    const double here = static_cast<double>(k);
    sweep.time.push_back(here * period);
    const auto way = static_cast<double>(std::min(k, 2 * steps - k));
    temperature.push_back(std::min(lowest + way * kSweepStep, highest));
    swept_rate.push_back(at_rest + kRateChange * std::sin(0.1 * here));
  }
  sweep.status.assign(samples, 0);
  for (const Column& column : recording.columns) {
    if (column.role != Role::kMeasured) continue;
    Column swept = column;
    swept.values.assign(samples, powered_mean(recording, column.values));
    if (column.name == "temperature") swept.values = temperature;
    if (column.name == "rate") swept.values = swept_rate;
    if (column.name == "output") {
      const SweepLine line = line_over(recording, rate, column.values);
      std::ranges::transform(swept_rate, swept.values.begin(),
                             [&line](double r) { return line.at(r); });
    }
    sweep.columns.push_back(std::move(swept));
  }
  return sweep;
}

std::vector<ReplayedBlock> replays_over_temperature(
    const RateEstimator& estimator, const Recording& recording,
    const TemperatureRange& range, double full_scale, std::size_t replays,
    const ReplayPauses& pauses, double period) {
  const Recording sweep = temperature_sweep(recording, range, period);
  const std::vector<double> answers = estimator(sweep);
  std::vector<ReplayedBlock> all;
  for (std::size_t first = 0; first < replays; ++first) {
    const auto blocks =
        replay(estimator, sweep, answers, full_scale, first, pauses);
    if (!blocks) return {};
    all.insert(all.end(), blocks->begin(), blocks->end());
  }
  return all;
}

}  // namespace beamgyro::internal
