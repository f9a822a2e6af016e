// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "bench/shipped_device.h"
#include "sim/dynamics/static_map.h"

namespace beamgyro {
namespace {

void project_device(benchmark::State& state) {
  const Device device = shipped_device();
  for (auto _ : state) benchmark::DoNotOptimize(project_beam(device));
}
BENCHMARK(project_device)->Unit(benchmark::kMillisecond);

void project_and_trim_device(benchmark::State& state) {
  const Device device = shipped_device();
  for (auto _ : state) benchmark::DoNotOptimize(make_gyro(device));
}
BENCHMARK(project_and_trim_device)->Unit(benchmark::kMillisecond);

// Materials, complex stiffness, couplings and the loop's root, uncached.
void static_solve(benchmark::State& state) {
  const Gyro gyro = make_gyro(shipped_device());
  double T = 233.15;
  for (auto _ : state) {
    benchmark::DoNotOptimize(beam_signal(gyro, T, {}));
    T = T < 323 ? T + 0.01 : 233.15;
  }
}
BENCHMARK(static_solve)->Unit(benchmark::kMicrosecond);

// What `characterise` does for its 401 temperatures.
void characterise_401_temperatures(benchmark::State& state) {
  const Device device = shipped_device();
  for (auto _ : state) {
    const Gyro gyro = make_gyro(device);
    for (int i = 0; i < 401; ++i) {
      const double T = 233.15 + 0.25 * i;
      const ModalParameters modal =
          modal_parameters(gyro.device, gyro.beam, T, gyro.stiffness_trim);
      benchmark::DoNotOptimize(beam_signal(gyro, modal, {}));
      benchmark::DoNotOptimize(zero_rate_terms(gyro, modal));
      benchmark::DoNotOptimize(rate_slope(gyro, modal, T));
    }
  }
}
BENCHMARK(characterise_401_temperatures)->Unit(benchmark::kMillisecond);

void build_static_map(benchmark::State& state) {
  const Gyro gyro = make_gyro(shipped_device());
  for (auto _ : state)
    benchmark::DoNotOptimize(StaticMap(gyro, 233.15, 328.15, 2.1));
}
BENCHMARK(build_static_map)->Unit(benchmark::kMillisecond);

void look_up_static_map(benchmark::State& state) {
  const Gyro gyro = make_gyro(shipped_device());
  const StaticMap map(gyro, 233.15, 328.15, 2.1);
  double T = 233.15;
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.at(T, 1.3));
    T = T < 328 ? T + 0.01 : 233.15;
  }
}
BENCHMARK(look_up_static_map)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace beamgyro
