// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench/bias_rows.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr double kNoise = 0.002;

void train(benchmark::State& state, Eigen::Index count, int inputs, int hidden,
           int restarts) {
  const ScaledRows training = bias_rows(count, inputs, kNoise, 0);
  const ScaledRows held_out = bias_rows(count / 2, inputs, kNoise, 1);
  double epochs = 0, rms = 0;
  for (auto _ : state) {
    epochs = 0;
    rms = 1e9;
    for (int k = 0; k < restarts; ++k) {
      BpNetwork network({inputs, hidden, 1});
      const auto restart = static_cast<std::uint32_t>(k);
      RandomStream weights(1, 0, restart, kInitialWeightsStream);
      RandomStream order(1, 0, restart, kSampleOrderStream);
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
}  // namespace beamgyro::internal
