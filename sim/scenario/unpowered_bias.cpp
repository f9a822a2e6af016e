// SPDX-License-Identifier: MIT
#include "sim/scenario/unpowered_bias.h"

#include <algorithm>

#include "sim/dynamics/static_map.h"

namespace beamgyro::internal {

UnpoweredBias::UnpoweredBias(const ScenarioPlan& scenario, const Gyro& gyro,
                             const Motion& motion,
                             const MemoryTrajectory* memory)
    : scenario_(scenario), gyro_(gyro), memory_(memory) {
  if (motion.has_other_axes())
    motion_.emplace(gyro, motion, scenario.output_rate);
}

void UnpoweredBias::fill_next(RunSamples& samples) {
  if (motion_) motion_->next(samples.time.size());
  std::vector<std::size_t> unpowered;
  for (std::size_t k = 0; k < samples.time.size(); ++k)
    if (!powered_at(scenario_.powered, samples.time[k])) unpowered.push_back(k);
  if (unpowered.empty()) return;
  if (motion_) {
    fill_moving(unpowered, samples);
  } else {
    fill_still(unpowered, samples);
  }
}

void UnpoweredBias::fill_moving(const std::vector<std::size_t>& unpowered,
                                RunSamples& samples) {
  for (const std::size_t k : unpowered) {
    CaseMotion motion = motion_->at(k);
    motion.z = 0;
    const ModalParameters modal =
        modal_at(gyro_, samples.temperature[kBeam][k],
                 memory_ ? samples.memory[k] : MemoryState{});
    samples.bias[k] =
        electronics_at(gyro_, samples.temperature[kBoard][k])
            .output(beam_signal(gyro_, modal, motion, path_).demodulated)
            .rate;
  }
}

void UnpoweredBias::fill_still(const std::vector<std::size_t>& unpowered,
                               RunSamples& samples) const {
  std::vector<double> beam;
  for (const std::size_t k : unpowered)
    beam.push_back(samples.temperature[kBeam][k]);
  const auto [low, high] = std::minmax_element(beam.begin(), beam.end());
  const StaticMap map = memory_ ? StaticMap(gyro_, *low, *high, 0,
                                            [this](double from, double to) {
                                              return memory_->range(from, to);
                                            })
                                : StaticMap(gyro_, *low, *high, 0);
  for (std::size_t i = 0; i < beam.size(); ++i) {
    const std::size_t k = unpowered[i];
    samples.bias[k] =
        electronics_at(gyro_, samples.temperature[kBoard][k])
            .output(
                map.at(beam[i], 0, memory_ ? samples.memory[k] : MemoryState{})
                    .at_rest)
            .rate;
  }
}

}  // namespace beamgyro::internal
