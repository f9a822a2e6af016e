// SPDX-License-Identifier: MIT
#include "sim/dynamics/modal_memory.h"

namespace beamgyro::internal {

ModalMemory::ModalMemory(const Gyro& gyro, const MemoryTrajectory& memory)
    : memory_(memory) {
  const bool turns = gyro.device.memory.hysteresis.has_value();
  for (std::size_t k = 0; k < memory.times().size(); ++k) {
    const double T = memory.beam()[k];
    MemoryState state = memory.knot(k);
    const double hysteresis = state.hysteresis;
    state.hysteresis = 0;
    const ModalChannels without = modal_channels(gyro, T, state);
    without_hysteresis_.add(without - modal_channels(gyro, T));
    if (!turns) continue;
    state.hysteresis = hysteresis < 0 ? -1 : 1;
    per_hysteresis_.add((modal_channels(gyro, T, state) - without) *
                        state.hysteresis);
  }
  without_hysteresis_.finish(memory.times(), memory.breaks());
  if (turns) per_hysteresis_.finish(memory.times(), memory.breaks());
}

ModalChannels ModalMemory::at(double t, double beam,
                              std::size_t& interval) const {
  const std::vector<double>& times = memory_.times();
  interval = interval_of(times, t, interval);
  ModalChannels sum = without_hysteresis_.at(times, interval, t);
  if (!per_hysteresis_.values().empty()) {
    sum += memory_.hysteresis(interval, beam) *
           per_hysteresis_.at(times, interval, t);
  }
  return sum;
}

}  // namespace beamgyro::internal
