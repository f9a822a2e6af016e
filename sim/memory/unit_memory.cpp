// SPDX-License-Identifier: MIT
#include "sim/memory/unit_memory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/numerics/timeline.h"

namespace beamgyro::internal {
namespace {

// How long a unit has rested since its trim before its history begins [s].
double rest_before(const UnitHistory& history) {
  if (!history.temperature) return history.age;
  const std::vector<double>& t = history.temperature->times();
  const double told = t.back() - t.front();
  return is_same_time(told, history.age) ? 0
                                         : std::max(0.0, history.age - told);
}

// Above T_g and all temperatures from `first` to `start` [K].
double hot_start(double glass_transition, const UnitHistory& history,
                 double first, double start) {
  constexpr double kAbove = 30;  // [K]
  double hottest = std::max({glass_transition, first, start});
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
  const double rested = rest_before(history);
  const double next =
      history.temperature ? history.temperature->values().front() : start;
  const double first = rested > 0 ? kAgeingTemperature : next;
  const double hot = hot_start(glass_transition, history, first, start);
  if (parameters.hysteresis) {
    hysteresis_.emplace(*parameters.hysteresis, hot);
    hysteresis_->push(first);
  }
  if (parameters.relaxation) {
    const std::optional<double>& offset = parameters.relaxation->initial_offset;
    relaxation_.emplace(*parameters.relaxation, glass_transition,
                        offset ? glass_transition + *offset : hot);
    if (!offset)
      relaxation_->advance(hot, first, (hot - first) / kHandlingRate);
  }
  if (parameters.ageing)
    ageing_.emplace(*parameters.ageing, parameters.ageing->trim_age);
  if (rested > 0)
    advance_patches(kAgeingTemperature, kAgeingTemperature, rested);
  bring(first, next);
  if (!history.temperature) return;
  live(*history.temperature, history.age);
  bring(history.temperature->values().back(), start);
}

// What a unit is taken through at kHandlingRate does not age it.
void UnitMemory::bring(double from, double to) {
  if (relaxation_ && to != from)
    relaxation_->advance(from, to, std::abs(to - from) / kHandlingRate);
  push_beam(to);
}

void UnitMemory::live(const PiecewiseLinear& history, double age) {
  const std::vector<double>& t = history.times();
  const std::vector<double>& T = history.values();
  const double trim = t.back() - age;
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

void UnitMemory::archive(StateArchive& archive) {
  if (relaxation_) archive(*relaxation_);
  if (hysteresis_) archive(*hysteresis_);
  if (ageing_) archive(*ageing_);
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
