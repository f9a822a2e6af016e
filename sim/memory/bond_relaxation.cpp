// SPDX-License-Identifier: MIT
#include "sim/memory/bond_relaxation.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {
namespace {

constexpr std::array<double, BondRelaxation::kModes> kFitted = {
    0.0361, 0.0269, 0.1127, 0.2339, 0.4528, 0.1375};

using FictiveModes = std::array<double, BondRelaxation::kModes>;

double mean_of(const FictiveModes& modes) {
  static const auto weights = BondRelaxation::weights();
  double sum = 0;
  for (std::size_t j = 0; j < modes.size(); ++j) sum += weights[j] * modes[j];
  return sum;
}

// Of a step of second order, taken whole and in two halves, to third order. A
// mode stays between its value before and the temperatures of the step.
FictiveModes extrapolated(const FictiveModes& before, double from, double to,
                          const FictiveModes& whole,
                          const FictiveModes& halves) {
  FictiveModes modes;
  for (std::size_t j = 0; j < modes.size(); ++j) {
    const auto [low, high] = std::minmax({before[j], from, to});
    modes[j] = std::clamp(halves[j] + (halves[j] - whole[j]) / 3, low, high);
  }
  return modes;
}

// T(t) is a straight line and tau is frozen, so T_fj is a mean of its value
// before and of both temperatures, with weights that are never negative.
FictiveModes with_tau(const FictiveModes& modes, double tau, double from,
                      double to, double duration) {
  constexpr double kNone = 1e-9, kAll = 40;  // beyond them exp() adds nothing
  FictiveModes next;
  for (std::size_t j = 0; j < modes.size(); ++j) {
    const double E = duration / (BondRelaxation::kTimes[j] * tau);
    if (E < kNone) {
      next[j] = modes[j] + E * (0.5 * (from + to) - modes[j]);
      continue;
    }
    const double lost = E < kAll ? -std::expm1(-E) : 1;
    const double kept = 1 - lost, lag = lost / E;
    next[j] =
        to * (1 - lag) + from * std::max(0.0, lag - kept) + modes[j] * kept;
  }
  return next;
}

}  // namespace

std::array<double, BondRelaxation::kModes> BondRelaxation::weights() {
  double sum = 0;
  for (const double g : kFitted) sum += g;
  std::array<double, kModes> weights = kFitted;
  for (double& g : weights) g /= sum;
  return weights;
}

BondRelaxation::BondRelaxation(const RelaxationParameters& parameters,
                               double glass_transition, double start)
    : activation_over_R_(parameters.activation / kGasConstant),
      nonlinearity_(parameters.nonlinearity),
      glass_transition_(glass_transition) {
  modes_.fill(start);
}

double BondRelaxation::fictive_temperature() const { return mean_of(modes_); }

double BondRelaxation::time_constant(double T) const {
  return time_constant(T, modes_);
}

double BondRelaxation::time_constant(double T, const Modes& modes) const {
  return kGlassTime *
         std::exp(activation_over_R_ *
                  (nonlinearity_ / T + (1 - nonlinearity_) / mean_of(modes) -
                   1 / glass_transition_));
}

// `tau` is the time constant at the start.
BondRelaxation::Modes BondRelaxation::stepped(const Modes& modes, double tau,
                                              double from, double to,
                                              double duration) const {
  const double middle = 0.5 * (from + to);
  const Modes half = with_tau(modes, tau, from, middle, 0.5 * duration);
  return with_tau(modes, time_constant(middle, half), from, to, duration);
}

BondRelaxation::Modes BondRelaxation::halved(const Modes& modes, double from,
                                             double to, double duration,
                                             int depth) const {
  constexpr int kDeepest = 40;
  const double middle = 0.5 * (from + to);
  constexpr double kFrozen = 3e-7, kEquilibrium = 1e-5;  // [K]
  const double tau = time_constant(from, modes);
  const Modes whole = stepped(modes, tau, from, to, duration);
  if (std::abs(mean_of(whole) - mean_of(modes)) < kFrozen ||
      std::abs(mean_of(whole) - to) < kEquilibrium)
    return whole;
  const Modes first = stepped(modes, tau, from, middle, 0.5 * duration);
  const Modes second =
      stepped(first, time_constant(middle, first), middle, to, 0.5 * duration);
  if (std::abs(mean_of(second) - mean_of(whole)) <= kError || depth == kDeepest)
    return extrapolated(modes, from, to, whole, second);
  return halved(halved(modes, from, middle, 0.5 * duration, depth + 1), middle,
                to, 0.5 * duration, depth + 1);
}

void BondRelaxation::advance(double from, double to, double duration) {
  // tau doubles with each K: wider steps would hide the lag at their end.
  constexpr double kWidest = 2;  // [K]
  const int parts =
      std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / kWidest)));
  for (int i = 0; i < parts; ++i) {
    modes_ =
        halved(modes_, std::lerp(from, to, double(i) / parts),
               std::lerp(from, to, double(i + 1) / parts), duration / parts, 0);
  }
}

double reference_fictive_temperature(double T, double glass_transition) {
  return std::max(T, glass_transition);
}

}  // namespace beamgyro::internal
