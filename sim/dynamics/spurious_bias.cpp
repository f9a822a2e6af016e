// SPDX-License-Identifier: MIT
#include "sim/dynamics/spurious_bias.h"

#include <algorithm>

namespace beamgyro::internal {

bool needs_exact_solution(const TrimmedGyro& gyro) {
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

double SpuriousBias::at_rest(const SpuriousTemperatures& temperatures,
                             const MemoryState& memory,
                             const Electronics& board) {
  const ModalParameters modal = modal_at(gyro_, temperatures, memory);
  return at(beam_signal(gyro_, modal, {}, path_).demodulated, temperatures,
            memory, {}, board);
}

}  // namespace beamgyro::internal
