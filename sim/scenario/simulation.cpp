// SPDX-License-Identifier: MIT
#include "sim/scenario/simulation.h"

#include <utility>
#include <vector>

#include "sim/scenario/envelope_run.h"

namespace beamgyro::internal {
namespace {

void reserve(Recording& recording, std::size_t samples) {
  recording.time.reserve(samples);
  recording.status.reserve(samples);
  for (Column& column : recording.columns) column.values.reserve(samples);
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append(Recording& recording, const Recording& block) {
  append(recording.time, block.time);
  append(recording.status, block.status);
  for (std::size_t i = 0; i < block.columns.size(); ++i)
    append(recording.columns[i].values, block.columns[i].values);
}

}  // namespace

void append_block(Recording& whole, Recording&& block, std::size_t samples) {
  if (!whole.columns.empty()) return append(whole, block);
  whole = std::move(block);
  reserve(whole, samples);
}

void simulate(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
              const RunKey& key, const BlockSink& on_block) {
  switch (scenario.fidelity) {
    case Fidelity::kQuasistatic:
      return simulate_quasistatic(scenario, gyro, key, on_block);
    case Fidelity::kEnvelope:
      return simulate_envelope(scenario, gyro, key, on_block);
    case Fidelity::kCarrier:
      return simulate_carrier(scenario, gyro, key, on_block);
  }
}

Recording simulated(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                    const RunKey& key) {
  Recording whole;
  if (scenario.fidelity == Fidelity::kQuasistatic) {  // in one block
    simulate_quasistatic(
        scenario, gyro, key,
        [&](Recording&& block) { whole = std::move(block); },
        sample_count(scenario));
    return whole;
  }
  simulate(scenario, gyro, key, [&](Recording&& block) {
    append_block(whole, std::move(block), sample_count(scenario));
  });
  return whole;
}

Recording simulated(const ScenarioPlan& scenario,
                    const DeviceParameters& device, const RunKey& key) {
  return simulated(scenario, make_gyro(device), key);
}

}  // namespace beamgyro::internal
