// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>

#include "compensation/network_training.h"

namespace beamgyro {
namespace {

// A bias curve with four extrema over [-1, 1] and label noise, in `inputs`
// variables of which the others shift the first.
ScaledRows rows(Eigen::Index count, Eigen::Index inputs, std::uint32_t run) {
  RandomStream random(5, 0, run, RandomPurpose::kWhiteNoise);
  ScaledRows set;
  set.inputs.resize(count, inputs);
  set.target.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    set.inputs(i, 0) =
        2 * static_cast<double>(i) / static_cast<double>(count - 1) - 1;
    double x = set.inputs(i, 0);
    for (Eigen::Index j = 1; j < inputs; ++j) {
      set.inputs(i, j) = 2 * random.uniform() - 1;
      x += 0.05 * set.inputs(i, j);
    }
    set.target(i) = 0.4 * std::sin(4 * x) + 0.5 * std::tanh(-6 * (x + 0.35)) +
                    0.002 * random.normal();
  }
  return set;
}

void train(benchmark::State& state, Eigen::Index count, int inputs, int hidden,
           int restarts) {
  const ScaledRows training = rows(count, inputs, 0);
  const ScaledRows held_out = rows(count / 2, inputs, 1);
  double epochs = 0, rms = 0;
  for (auto _ : state) {
    epochs = 0;
    rms = 1e9;
    for (int k = 0; k < restarts; ++k) {
      BpNetwork network({inputs, hidden, 1});
      const auto restart = static_cast<std::uint32_t>(k);
      RandomStream weights(1, 0, restart, RandomPurpose::kInitialWeights);
      RandomStream order(1, 0, restart, RandomPurpose::kSampleOrder);
      network.randomise(weights);
      const TrainSummary summary =
          train_network(training, held_out, {}, order, network);
      epochs += summary.epochs;
      rms = std::min(rms, summary.held_out_rms.value());
    }
  }
  state.counters["epochs"] = epochs;
  state.counters["held_out_rms"] = rms;
}

BENCHMARK_CAPTURE(train, levenberg_marquardt_1_6_1_on_37, 37, 1, 6, 1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(train, levenberg_marquardt_1_6_1_on_37_8_restarts, 37, 1, 6,
                  8)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(train, levenberg_marquardt_3_14_1_on_20000, 20000, 3, 14, 1)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);

}  // namespace
}  // namespace beamgyro
