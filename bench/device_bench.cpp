// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <vector>

#include "bench/shipped_device.h"
#include "sim/dynamics/static_map.h"

namespace beamgyro::internal {
namespace {

void project_device(benchmark::State& state) {
  const DeviceParameters device = shipped_device();
  for (auto _ : state) benchmark::DoNotOptimize(project_beam(device));
}
BENCHMARK(project_device)->Unit(benchmark::kMillisecond);

void project_and_trim_device(benchmark::State& state) {
  const DeviceParameters device = shipped_device();
  for (auto _ : state) benchmark::DoNotOptimize(make_gyro(device));
}
BENCHMARK(project_and_trim_device)->Unit(benchmark::kMillisecond);

// Materials, complex stiffness, couplings and the loop's root, uncached.
void static_solve(benchmark::State& state) {
  const TrimmedGyro gyro = make_gyro(shipped_device());
  double T = 233.15;
  for (auto _ : state) {
    benchmark::DoNotOptimize(beam_signal(gyro, T, {}));
    T = T < 323 ? T + 0.01 : 233.15;
  }
}
BENCHMARK(static_solve)->Unit(benchmark::kMicrosecond);

// All that a run over -40 to 55 degC and +-120 deg/s needs of a new device.
void prepare_device(benchmark::State& state) {
  const DeviceParameters device = shipped_device();
  for (auto _ : state) {
    const TrimmedGyro gyro = make_gyro(device);
    benchmark::DoNotOptimize(StaticMap(gyro, 233.15, 328.15, 2.1));
  }
}
BENCHMARK(prepare_device)->Unit(benchmark::kMillisecond);

// What `characterise` does for its 401 temperatures.
void characterise_401_temperatures(benchmark::State& state) {
  const DeviceParameters device = shipped_device();
  for (auto _ : state) {
    const TrimmedGyro gyro = make_gyro(device);
    for (int i = 0; i < 401; ++i) {
      const double T = 233.15 + 0.25 * i;
      const ModalParameters modal = modal_at(gyro, T);
      benchmark::DoNotOptimize(beam_signal(gyro, modal, {}));
      benchmark::DoNotOptimize(zero_rate_terms(gyro, modal));
      benchmark::DoNotOptimize(rate_slope(gyro, modal, T));
    }
  }
}
BENCHMARK(characterise_401_temperatures)->Unit(benchmark::kMillisecond);

void build_static_map(benchmark::State& state) {
  const TrimmedGyro gyro = make_gyro(shipped_device());
  for (auto _ : state)
    benchmark::DoNotOptimize(StaticMap(gyro, 233.15, 328.15, 2.1));
}
BENCHMARK(build_static_map)->Unit(benchmark::kMillisecond);

// A block of samples, as runs look them up.
void look_up_static_map(benchmark::State& state) {
  const TrimmedGyro gyro = make_gyro(shipped_device());
  const StaticMap map(gyro, 233.15, 328.15, 2.1);
  std::vector<double> T(256), rate(256, 1.3);
  for (std::size_t k = 0; k < T.size(); ++k)
    T[k] = 300 + 1e-3 * static_cast<double>(k);
  std::vector<StaticMap::Signals> signals(T.size());
  for (auto _ : state) {
    map.sample(T, rate, {}, signals);
    benchmark::DoNotOptimize(signals.data());
  }
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(T.size()),
                         benchmark::Counter::kIsIterationInvariantRate |
                             benchmark::Counter::kInvert);
}
BENCHMARK(look_up_static_map)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace beamgyro::internal
