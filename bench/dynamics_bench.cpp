// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bench/shipped_device.h"
#include "sim/scenario/envelope_run.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kReference = 1e-11;                // tolerance [rad/s]

const SineSignal kSine{.amplitude = 10 * kDegree, .frequency = 0.05};

ScenarioPlan warm_up(const RateProfile& rate, double duration,
                     double output_rate) {
  ScenarioPlan scenario;
  scenario.duration = duration;
  scenario.output_rate = output_rate;
  scenario.seed = 1;
  scenario.powered = {{.on = 0}};
  scenario.motion[kRateZ] = rate;
  scenario.noise_enabled = false;
  return scenario;
}

double largest_difference(const std::vector<double>& a,
                          const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest / kDegree;
}

// 1500 s from power-on with loops, heat and output at 10 Hz, and the twin if
// the rate is not zero. The error is that of the output against the same
// equations at a tight tolerance.
void envelope(benchmark::State& state, const RateProfile& rate) {
  const ScenarioPlan scenario = warm_up(rate, 1500, 10);
  const TrimmedGyro gyro = make_gyro(shipped_device());
  const Motion motion(scenario, gyro, {});
  const std::vector<double> times = sample_times(scenario);
  std::vector<double> output;
  long steps = 0, evaluations = 0;
  for (auto _ : state) {
    EnvelopeTrajectory run(scenario, gyro, motion, false);
    output = run.advance(times).output;
    steps = run.steps();
    evaluations = run.rhs_evaluations();
    if (motion.rate_is_zero()) continue;
    EnvelopeTrajectory twin(scenario, gyro, motion, true);
    benchmark::DoNotOptimize(twin.advance(times));
  }
  EnvelopeTrajectory reference(scenario, gyro, motion, false, nullptr,
                               kReference);
  state.counters["error_deg_per_s"] =
      largest_difference(output, reference.advance(times).output);
  state.counters["steps"] = static_cast<double>(steps);
  state.counters["rhs"] = static_cast<double>(evaluations);
}

// A second of start-up at 2 kHz, twin included.
void carrier(benchmark::State& state, const RateProfile& rate) {
  const ScenarioPlan scenario = [&] {
    ScenarioPlan s = warm_up(rate, 1, 2000);
    s.fidelity = Fidelity::kCarrier;
    return s;
  }();
  const DeviceParameters device = shipped_device();
  for (auto _ : state)
    simulate_carrier(scenario, make_gyro(device), {}, [](Recording&& block) {
      benchmark::DoNotOptimize(block);
    });
}

// A day of changing ambient at 10 Hz, block by block.
void envelope_day(benchmark::State& state) {
  ScenarioPlan scenario = warm_up(PiecewiseLinear::constant(0), 86400, 10);
  scenario.fidelity = Fidelity::kEnvelope;
  scenario.ambient = PiecewiseLinear({0, 21600, 43200, 64800, 86400},
                                     {253.15, 313.15, 253.15, 313.15, 253.15});
  scenario.noise_enabled = true;
  const DeviceParameters device = shipped_device();
  for (auto _ : state)
    simulate_envelope(scenario, make_gyro(device), {}, [](Recording&& block) {
      benchmark::DoNotOptimize(block);
    });
}

BENCHMARK_CAPTURE(envelope, at_rest, PiecewiseLinear::constant(0))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(envelope, under_a_sine_with_twin, kSine)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(carrier, second_at_rest, PiecewiseLinear::constant(0))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(carrier, second_with_rate_and_twin,
                  PiecewiseLinear::constant(10 * kDegree))
    ->Unit(benchmark::kMillisecond);
BENCHMARK(envelope_day)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beamgyro::internal
