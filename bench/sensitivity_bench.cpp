// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sensitivity/study/device_sample.h"
#include "sensitivity/study/sensitivity_study.h"
#include "sim/campaign/campaign.h"

namespace beamgyro::internal {
namespace {

CampaignPlan shipped_population() {
  return CampaignPlan::read(std::string(BEAMGYRO_SCENARIOS) +
                            "/campaigns/population.toml");
}

// A curve of the bias is a device drawn, solved and tabulated at 37
// temperatures, on one thread: 30,000 of them take 30 times as long.
void sample_population(benchmark::State& state, std::vector<Merit> merits) {
  const CampaignPlan campaign = shipped_population();
  DeviceSampleOptions options;
  options.merits = std::move(merits);
  options.rows = 64;
  options.jobs = 1;
  std::uint64_t devices = 0;
  for (auto _ : state) {
    DeviceSampleCounts counts;
    benchmark::DoNotOptimize(sample_devices(campaign, options, counts));
    devices += counts.devices;
  }
  state.counters["curves"] = benchmark::Counter(static_cast<double>(devices),
                                                benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(sample_population, bias, {Merit::kBiasPeakToPeak})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sample_population, four_figures,
                  {Merit::kBiasPeakToPeak, Merit::kCubicRms,
                   Merit::kScaleFactorDrift, Merit::kWarmUpChange})
    ->Unit(benchmark::kMillisecond);

// Indices and intervals of 2048 rows and 13 factors.
void analyse_figure(benchmark::State& state) {
  const CampaignPlan campaign = shipped_population();
  DeviceSampleOptions options;
  options.merits = {Merit::kWarmUpChange};
  DeviceSampleCounts counts;
  const DeviceSample sample = sample_devices(campaign, options, counts);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        analysed(sample, 0, {Merit::kWarmUpChange, false}, 1));
}
BENCHMARK(analyse_figure)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beamgyro::internal
