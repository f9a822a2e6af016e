// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <string>

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
BENCHMARK_CAPTURE(snapshot, nominal, "nominal");
BENCHMARK_CAPTURE(snapshot, lifelike, "lifelike");
BENCHMARK_CAPTURE(prepare, nominal, "nominal");
BENCHMARK_CAPTURE(prepare, trimmed, "trimmed");

}  // namespace
}  // namespace beamgyro::internal
