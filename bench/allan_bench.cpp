// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

/// White rates at 100 Hz.
EvenSeries white_series(benchmark::State& state) {
  std::vector<double> rates(static_cast<std::size_t>(state.range(0)));
  RandomStream(1, 0, 0, RandomPurpose{0}).fill_normal(rates);
  EvenSeries series;
  series.interval = 0.01;
  series.samples = rates.size();
  series.stretches.push_back(std::move(rates));
  return series;
}

void deviations(benchmark::State& state, DeviationKind kind) {
  const EvenSeries series = white_series(state);
  const std::vector<double> taus = octave_taus(series);
  for (auto _ : state)
    benchmark::DoNotOptimize(deviation_curves(series, std::array{kind}, taus));
}
BENCHMARK_CAPTURE(deviations, oadev_at_octaves, DeviationKind::kOadev)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(deviations, mdev_at_octaves, DeviationKind::kMdev)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(deviations, totdev_at_octaves, DeviationKind::kTotdev)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond);

void coefficients(benchmark::State& state) {
  const EvenSeries series = white_series(state);
  const auto points = allan_curve(series, octave_taus(series)).overlapping;
  for (auto _ : state) benchmark::DoNotOptimize(noise_coefficients(points));
}
BENCHMARK(coefficients)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beamgyro::internal
