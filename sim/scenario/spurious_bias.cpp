// SPDX-License-Identifier: MIT
#include "sim/scenario/spurious_bias.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sim/dynamics/static_map.h"

namespace beamgyro::internal {

bool needs_exact_solution(const Gyro& gyro) {
  const auto& modes = gyro.device.spurious_modes;
  return !modes.empty() &&
         (gyro.device.memory.any() ||
          std::ranges::any_of(modes, &SpuriousModeParameters::follows_housing));
}

double SpuriousBias::at(Complex with, const SpuriousTemperatures& temperatures,
                        const MemoryState& memory, const CaseMotion& motion,
                        const Electronics& board) {
  const ModalParameters modal = modal_at(without_, temperatures, memory);
  return of(with,
            beam_signal(without_, modal, motion, path_without_).demodulated,
            board);
}

void SpuriousBias::fill(RunSamples& samples) {
  if (needs_exact_solution(gyro_)) return fill_exactly(samples);
  const std::vector<double>& beam = samples.temperature[kBeam];
  const auto [low, high] = std::ranges::minmax_element(beam);
  const std::vector<double> rate(beam.size(), 0.0);
  std::vector<StaticMap::Signals> signals(beam.size());
  StaticMap(gyro_, *low, *high, 0).sample(beam, rate, {}, signals);
  samples.spurious_bias.resize(beam.size());
  for (std::size_t k = 0; k < beam.size(); ++k) {
    samples.spurious_bias[k] =
        of(signals[k].at_rest, signals[k].without_spurious,
           electronics_at(gyro_, samples.temperature[kBoard][k]));
  }
}

void SpuriousBias::fill_exactly(RunSamples& samples) {
  const std::size_t count = samples.time.size();
  samples.spurious_bias.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const SpuriousTemperatures temperatures = {
        samples.temperature[kBeam][k], samples.temperature[kHousing][k]};
    const MemoryState memory =
        samples.memory.empty() ? MemoryState{} : samples.memory[k];
    const ModalParameters modal = modal_at(gyro_, temperatures, memory);
    samples.spurious_bias[k] =
        at(beam_signal(gyro_, modal, {}, path_).demodulated, temperatures,
           memory, {}, electronics_at(gyro_, samples.temperature[kBoard][k]));
  }
}

}  // namespace beamgyro::internal
