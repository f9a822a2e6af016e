// SPDX-License-Identifier: MIT
#include "sim/memory/unit_memory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamgyro::internal {
namespace {

// Temperatures of a history in which the bond is cooled from above T_g.
double hot_start(double glass_transition, const UnitHistory& history,
                 double start) {
  constexpr double kAbove = 30;  // [K]
  double hottest = std::max(glass_transition, start);
  if (history.temperature) {
    for (const double T : history.temperature->values())
      hottest = std::max(hottest, T);
  }
  return hottest + kAbove;
}

}  // namespace

double ageing_rate(double activation, double T) {
  return std::exp(-activation / kGasConstant *
                  (1 / T - 1 / kAgeingTemperature));
}

Ageing::Ageing(const AgeingParameters& parameters, double age)
    : parameters_(parameters), age_(age) {}

void Ageing::advance(double from, double to, double duration) {
  // Simpson's rule on at most 5 K: exact to 1e-7 for E_a up to 1e5 J/mol.
  constexpr double kWidest = 5;  // [K]
  const int parts = 1 + static_cast<int>(std::abs(to - from) / kWidest);
  const auto rate = [&](double place) {
    return ageing_rate(parameters_.activation,
                       std::lerp(from, to, place / parts));
  };
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    sum += (rate(i) + 4 * rate(i + 0.5) + rate(i + 1)) / 6;
  age_ += sum / parts * duration;
}

double Ageing::decades() const {
  const double after = (age_ - parameters_.trim_age) /
                       (parameters_.trim_age + parameters_.start);
  return std::log1p(after) / std::numbers::ln10;
}

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

UnitMemory::UnitMemory(const MemoryParameters& parameters,
                       double glass_transition, const UnitHistory& history,
                       double start)
    : glass_transition_(glass_transition) {
  constexpr double kCooling = 1.0 / 60;  // [K/s]
  const double hot = hot_start(glass_transition, history, start);
  const double first =
      history.temperature ? history.temperature->values().front() : start;
  if (parameters.hysteresis) {
    hysteresis_.emplace(*parameters.hysteresis, hot);
    hysteresis_->push(first);
  }
  if (parameters.relaxation) {
    const std::optional<double>& offset = parameters.relaxation->initial_offset;
    relaxation_.emplace(*parameters.relaxation, glass_transition,
                        offset ? glass_transition + *offset : hot);
    if (!offset) relaxation_->advance(hot, first, (hot - first) / kCooling);
  }
  if (parameters.ageing)
    ageing_.emplace(*parameters.ageing, parameters.ageing->trim_age);
  if (history.temperature) {
    live(*history.temperature, history.age);
  } else if (ageing_) {
    ageing_->advance(kAgeingTemperature, kAgeingTemperature, history.age);
  }
  push_beam(start);
}

void UnitMemory::live(const PiecewiseLinear& history, double age) {
  const std::vector<double>& t = history.times();
  const std::vector<double>& T = history.values();
  const double trim = t.back() - age;
  if (ageing_ && trim < t.front()) {
    ageing_->advance(kAgeingTemperature, kAgeingTemperature, t.front() - trim);
  }
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    push_beam(T[i]);
    push_beam(T[i + 1]);
    if (relaxation_) relaxation_->advance(T[i], T[i + 1], t[i + 1] - t[i]);
    if (!ageing_ || t[i + 1] <= trim) continue;
    const double from = std::max(t[i], trim);
    const double share = (from - t[i]) / (t[i + 1] - t[i]);
    ageing_->advance(std::lerp(T[i], T[i + 1], share), T[i + 1],
                     t[i + 1] - from);
  }
}

void UnitMemory::advance_patches(double from, double to, double duration) {
  if (relaxation_) relaxation_->advance(from, to, duration);
  if (ageing_) ageing_->advance(from, to, duration);
}

void UnitMemory::push_beam(double T) {
  if (hysteresis_) hysteresis_->push(T);
}

MemoryState UnitMemory::state(double patches) const {
  MemoryState state;
  if (relaxation_) {
    state.glass_offset =
        relaxation_->fictive_temperature() -
        reference_fictive_temperature(patches, glass_transition_);
  }
  if (hysteresis_) state.hysteresis = hysteresis_->share();
  if (ageing_) state.decades = ageing_->decades();
  return state;
}

}  // namespace beamgyro::internal
