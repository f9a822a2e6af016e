// SPDX-License-Identifier: MIT
#include "sim/scenario/envelope_run.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/scenario/aligned_borders.h"
#include "sim/scenario/envelope_trajectory.h"
#include "sim/scenario/motion.h"
#include "sim/scenario/run_memory.h"
#include "sim/scenario/sensing_noise.h"
#include "sim/scenario/unpowered_bias.h"

namespace beamgyro::internal {

void simulate_envelope(const ScenarioPlan& scenario,
                       const DeviceParameters& device, const RunKey& key,
                       const BlockSink& on_block) {
  simulate_envelope(scenario, make_gyro(device), key, on_block);
}

void simulate_envelope(const ScenarioPlan& given, const Gyro& gyro,
                       const RunKey& key, const BlockSink& on_block) {
  const ScenarioPlan scenario = with_aligned_borders(given);
  const Motion motion(scenario, gyro, key);
  const std::unique_ptr<MemoryTrajectory> memory =
      memory_of_run(scenario, gyro);
  std::optional<ModalMemory> remembered;
  if (memory) remembered.emplace(gyro, *memory);
  const ModalMemory* added = remembered ? &*remembered : nullptr;
  EnvelopeTrajectory trajectory(scenario, gyro, motion, false, added);
  std::optional<EnvelopeTrajectory> twin;
  if (!motion.rate_is_zero()) twin.emplace(scenario, gyro, motion, true, added);
  UnpoweredBias unpowered_bias(scenario, gyro, motion, memory.get());
  std::optional<SensingNoise> noise;
  if (scenario.noise_enabled) noise.emplace(scenario, gyro, key);
  RunRecorder recorder(scenario, gyro.device, key,
                       noise ? noise->rms() : RunNoise{});

  const SampleGrid grid = sample_grid(scenario);
  for (std::size_t k = 0; k < grid.count; k += kBlockSamples) {
    const std::vector<double> block =
        grid.times(k, std::min(kBlockSamples, grid.count - k));
    RunSamples samples = trajectory.advance(block);
    samples.bias = twin ? twin->advance(block).output : samples.output;
    if (memory) {
      samples.memory.resize(block.size());
      memory->sample(block, samples.temperature[kBeam], samples.memory);
    }
    unpowered_bias.fill_next(samples);
    motion.sample(samples);
    if (noise) noise->add_next(samples);
    on_block(recorder.block(std::move(samples)));
  }
}

}  // namespace beamgyro::internal
