// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "bench/shipped_device.h"
#include "dataset/netcdf/recording_file.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

constexpr double kDuration = 3600;  // [s]

// An hour at 10 Hz from power-on at 25 degC, all noise on.
ScenarioPlan warm_up(const RateProfile& rate) {
  ScenarioPlan scenario;
  scenario.duration = kDuration;
  scenario.output_rate = 10;
  scenario.seed = 1;
  scenario.powered = {{.on = 0}};
  scenario.motion[kRateZ] = rate;
  return scenario;
}

void report_speed(benchmark::State& state) {
  state.counters["times_real_time"] = benchmark::Counter(
      kDuration, benchmark::Counter::kIsIterationInvariantRate);
}

void run_in_memory(benchmark::State& state, const RateProfile& rate) {
  const DeviceParameters device = shipped_device();
  const ScenarioPlan scenario = warm_up(rate);
  for (auto _ : state) benchmark::DoNotOptimize(simulated(scenario, device));
  report_speed(state);
}

// The same of a device that is at hand, as in the later runs of a set.
void run_of_a_prepared_device(benchmark::State& state) {
  const TrimmedGyro gyro = make_gyro(shipped_device());
  const ScenarioPlan scenario = warm_up(PiecewiseLinear::constant(0));
  for (auto _ : state) benchmark::DoNotOptimize(simulated(scenario, gyro));
  report_speed(state);
}

void run_to_file(benchmark::State& state) {
  const DeviceParameters device = shipped_device();
  const ScenarioPlan scenario = warm_up(PiecewiseLinear::constant(0));
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "beamgyro_bench.h5";
  for (auto _ : state) write_recording(simulated(scenario, device), file);
  std::filesystem::remove(file);
  report_speed(state);
}

void thermal_hour(benchmark::State& state) {
  const ThermalNetwork network(shipped_device().thermal);
  const ThermalLoad load{.ambient = PiecewiseLinear::constant(298.15),
                         .powered = {{.on = 0}}};
  const std::vector<double> times =
      sample_times(warm_up(PiecewiseLinear::constant(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(simulate_temperatures(network, load, times));
}

void noise_hour(benchmark::State& state) {
  const NoiseParameters parameters = shipped_device().noise;
  std::vector<double> rate(36000);
  for (auto _ : state) {
    RateNoise(parameters, 10, 1, 0, 0).add_next(rate);
    benchmark::DoNotOptimize(rate.data());
  }
}

constexpr double kDegree = std::numbers::pi / 180;

BENCHMARK_CAPTURE(run_in_memory, at_rest, PiecewiseLinear::constant(0))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_in_memory, sine_rate,
                  SineSignal{.amplitude = 100 * kDegree, .frequency = 0.05})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(run_of_a_prepared_device)->Unit(benchmark::kMillisecond);
BENCHMARK(run_to_file)->Unit(benchmark::kMillisecond);
BENCHMARK(thermal_hour)->Unit(benchmark::kMillisecond);
BENCHMARK(noise_hour)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beamgyro::internal
