// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "bench/shipped_device.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro::internal {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]

// A step of 1 ms with all noise, at a rate that changes from step to step.
void step(benchmark::State& state, const std::string& device, bool three_axes) {
  GyroStepper stepper(stepper_model(make_gyro(shipped_device(device))),
                      {.seed = 1, .noise_rate = 1000});
  StepInputs inputs;
  double k = 0;
  for (auto _ : state) {
    inputs.motion[kRateZ] = 50 * kDegree * std::sin(0.001 * ++k);
    if (three_axes) {
      inputs.motion[kRateX] = 20 * kDegree;
      inputs.motion[kAccelerationZ] = 9.8;
    }
    benchmark::DoNotOptimize(stepper.step(1e-3, inputs, true));
  }
}
// One step of each of many gyros of one device, in one thread.
void step_many(benchmark::State& state, const std::string& device, int count) {
  const auto model = stepper_model(make_gyro(shipped_device(device)));
  std::vector<GyroStepper> gyros;
  for (int k = 0; k < count; ++k)
    gyros.emplace_back(model,
                       StepperStart{.seed = static_cast<std::uint64_t>(k),
                                    .noise_rate = 1000});
  StepInputs inputs;
  double k = 0;
  for (auto _ : state) {
    inputs.motion[kRateZ] = 50 * kDegree * std::sin(0.001 * ++k);
    for (GyroStepper& gyro : gyros)
      benchmark::DoNotOptimize(gyro.step(1e-3, inputs, true));
  }
}
void snapshot(benchmark::State& state, const std::string& device) {
  const GyroStepper stepper(stepper_model(make_gyro(shipped_device(device))),
                            {.seed = 1, .noise_rate = 1000});
  for (auto _ : state) benchmark::DoNotOptimize(stepper.state());
}
void prepare(benchmark::State& state, const std::string& device) {
  const TrimmedGyro gyro = make_gyro(shipped_device(device));
  for (auto _ : state) benchmark::DoNotOptimize(stepper_model(gyro));
}

BENCHMARK_CAPTURE(step, nominal, "nominal", false);
BENCHMARK_CAPTURE(step, nominal_three_axes, "nominal", true);
BENCHMARK_CAPTURE(step, lifelike, "lifelike", false);
BENCHMARK_CAPTURE(step, lifelike_three_axes, "lifelike", true);
BENCHMARK_CAPTURE(step, trimmed, "trimmed", false);
BENCHMARK_CAPTURE(step, with_modes, "lifelike_with_modes", false);
BENCHMARK_CAPTURE(step_many, nominal_1000, "nominal", 1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step_many, lifelike_300, "lifelike", 300)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(snapshot, nominal, "nominal");
BENCHMARK_CAPTURE(snapshot, lifelike, "lifelike");
BENCHMARK_CAPTURE(prepare, nominal, "nominal");
BENCHMARK_CAPTURE(prepare, trimmed, "trimmed");

}  // namespace
}  // namespace beamgyro::internal
