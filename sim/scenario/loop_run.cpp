// SPDX-License-Identifier: MIT
#include "sim/scenario/loop_run.h"

#include <algorithm>
#include <utility>

#include "sim/dynamics/static_map.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/run_temperatures.h"

namespace beamgyro::internal {
namespace {

std::optional<SensingNoise> noise_of(const ScenarioPlan& scenario,
                                     const TrimmedGyro& gyro,
                                     const RunKey& key) {
  std::optional<SensingNoise> noise;
  if (scenario.noise_enabled) noise.emplace(scenario, gyro, key);
  return noise;
}

}  // namespace

LoopRun::LoopRun(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                 const RunKey& key)
    : scenario_(scenario),
      gyro_(gyro),
      motion_(scenario, gyro, key),
      memory_(memory_of_run(scenario, gyro)),
      noise_(noise_of(scenario, gyro, key)),
      recorder_(scenario, gyro.device, key,
                noise_ ? noise_->rms() : RunNoise{}) {
  if (memory_) added_.emplace(gyro, *memory_);
  if (!gyro.device.spurious_modes.empty()) spurious_.emplace(gyro);
  if (motion_.has_other_axes())
    filtered_.emplace(gyro, motion_, scenario.output_rate);
}

Recording LoopRun::block(RunSamples&& samples) {
  if (memory_) {
    samples.memory.resize(samples.time.size());
    memory_->sample(samples.time, samples.temperature[kBeam], samples.memory);
  }
  fill_unpowered_bias(samples);
  if (spurious_) fill_spurious_bias(samples);
  motion_.sample(samples);
  if (noise_) noise_->add_next(samples);
  return recorder_.block(std::move(samples));
}

void LoopRun::fill_unpowered_bias(RunSamples& samples) {
  if (filtered_) filtered_->next(samples.time.size());
  std::vector<std::size_t> unpowered;
  for (std::size_t k = 0; k < samples.time.size(); ++k)
    if (!powered_at(scenario_.powered, samples.time[k])) unpowered.push_back(k);
  if (unpowered.empty()) return;
  if (filtered_ || needs_exact_solution(gyro_))
    return fill_moving(unpowered, samples);
  try {
    fill_still(unpowered, samples);
  } catch (const SimulationFailure&) {
    if (!memory_) throw;
    // No table spans the states; a failure at a sample is thrown there.
    fill_moving(unpowered, samples);
  }
}

void LoopRun::fill_moving(const std::vector<std::size_t>& unpowered,
                          RunSamples& samples) {
  for (const std::size_t k : unpowered) {
    CaseMotion motion = filtered_ ? filtered_->at(k) : CaseMotion{};
    motion.z = 0;
    const ModalParameters modal =
        modal_at(gyro_,
                 SpuriousTemperatures{samples.temperature[kBeam][k],
                                      samples.temperature[kHousing][k]},
                 memory_ ? samples.memory[k] : MemoryState{});
    samples.bias[k] =
        electronics_at(gyro_, samples.temperature[kBoard][k])
            .output(beam_signal(gyro_, modal, motion, path_).demodulated)
            .rate;
  }
}

void LoopRun::fill_still(const std::vector<std::size_t>& unpowered,
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

// Of a unit at rest.
void LoopRun::fill_spurious_bias(RunSamples& samples) {
  const std::vector<double>& beam = samples.temperature[kBeam];
  const auto board = [&](std::size_t k) {
    return electronics_at(gyro_, samples.temperature[kBoard][k]);
  };
  samples.spurious_bias.resize(beam.size());
  if (needs_exact_solution(gyro_)) {
    for (std::size_t k = 0; k < beam.size(); ++k)
      samples.spurious_bias[k] = spurious_->at_rest(
          {beam[k], samples.temperature[kHousing][k]},
          samples.memory.empty() ? MemoryState{} : samples.memory[k], board(k));
    return;
  }
  const auto [low, high] = std::ranges::minmax_element(beam);
  const std::vector<double> rate(beam.size(), 0.0);
  std::vector<StaticMap::Signals> signals(beam.size());
  StaticMap(gyro_, *low, *high, 0).sample(beam, rate, {}, signals);
  for (std::size_t k = 0; k < beam.size(); ++k)
    samples.spurious_bias[k] = spurious_->of(
        signals[k].at_rest, signals[k].without_spurious, board(k));
}

}  // namespace beamgyro::internal
