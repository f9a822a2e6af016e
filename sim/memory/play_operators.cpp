// SPDX-License-Identifier: MIT
#include "sim/memory/play_operators.h"

#include <algorithm>

namespace beamgyro::internal {

PlayOperators::PlayOperators(const HysteresisParameters& parameters,
                             double start)
    : parameters_(parameters), temperature_(start) {
  states_.fill(start);
  for (std::size_t i = 0; i < kPlayOperators; ++i)
    largest_ += parameters_.weight[i] * parameters_.half_width[i];
}

void PlayOperators::push(double T) {
  temperature_ = T;
  for (std::size_t i = 0; i < kPlayOperators; ++i) {
    const double r = parameters_.half_width[i];
    states_[i] = std::min(std::max(states_[i], T - r), T + r);
  }
}

double PlayOperators::value(const States& states, double T) const {
  double sum = 0;
  for (std::size_t i = 0; i < kPlayOperators; ++i) {
    // p_i - T clamped, which is -r or r to the last bit where T pushes.
    const double r = parameters_.half_width[i];
    sum += parameters_.weight[i] * std::clamp(states[i] - T, -r, r);
  }
  return sum;
}

double PlayOperators::value() const { return value(states_, temperature_); }

double PlayOperators::share() const { return value() / largest_; }

double PlayOperators::share(const States& states, double T) const {
  return value(states, T) / largest_;
}

}  // namespace beamgyro::internal
