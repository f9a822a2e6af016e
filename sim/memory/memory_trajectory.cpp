// SPDX-License-Identifier: MIT
#include "sim/memory/memory_trajectory.h"

#include <algorithm>
#include <cmath>

namespace beamgyro {
namespace {

// A component of a step and its slope by Horner's rule.
double value_of(const OdeStep& step, Eigen::Index row, double t) {
  const double s = (t - step.centre) / step.size;
  double value = 0;
  for (Eigen::Index k = step.order; k >= 0; --k)
    value = value * s + step.coefficients(row, k);
  return value;
}

double slope_of(const OdeStep& step, Eigen::Index row, double t) {
  const double s = (t - step.centre) / step.size;
  double slope = 0;
  for (Eigen::Index k = step.order; k >= 1; --k)
    slope = slope * s + static_cast<double>(k) * step.coefficients(row, k);
  return slope;
}

// Adds the zeros of `f` in (times[0], times.back()), one between two times.
template <class Function>
void add_zeros(const std::vector<double>& times, const Function& f,
               std::vector<double>& zeros) {
  constexpr int kBisections = 50;
  double left = f(times.front());
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double right = f(times[i + 1]);
    if ((left < 0 && right > 0) || (left > 0 && right < 0)) {
      double a = times[i], b = times[i + 1];
      for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (a + b);
        ((f(middle) < 0) == (left < 0) ? a : b) = middle;
      }
      zeros.push_back(b);
    }
    left = right;
  }
}

}  // namespace

MemoryTrajectory::MemoryTrajectory(const UnitMemory& start) : memory_(start) {}

ThermalSink MemoryTrajectory::sink() {
  return {
      .on_state = [this](double t, const Eigen::VectorXd& y) { begin(t, y); },
      .on_step = [this](const OdeStep& step) { take(step); }};
}

void MemoryTrajectory::add_knot(double t, double beam, double patches) {
  memory_.push_beam(beam);
  const MemoryState state = memory_.state(patches);
  times_.push_back(t);
  beam_.push_back(beam);
  breaks_.push_back(0);
  if (memory_.hysteresis()) plays_.push_back(memory_.hysteresis()->states());
  hysteresis_.push_back(state.hysteresis);
  glass_.add(state.glass_offset);
  decades_.add(state.decades);
}

void MemoryTrajectory::begin(double t, const Eigen::VectorXd& y) {
  if (times_.empty()) add_knot(t, y(kBeam), y(kPzt));
  breaks_.back() = 1;
}

void MemoryTrajectory::take(const OdeStep& step) {
  const auto beam = [&](double t) { return value_of(step, kBeam, t); };
  const auto patches = [&](double t) { return value_of(step, kPzt, t); };
  const double moved =
      std::max(std::abs(beam(step.end) - beam(step.begin)),
               std::abs(patches(step.end) - patches(step.begin)));
  const int parts =
      std::max(4, static_cast<int>(std::ceil(moved / kWidestStep)));
  std::vector<double> grid;
  for (int i = 0; i <= parts; ++i)
    grid.push_back(std::lerp(step.begin, step.end, double(i) / parts));

  std::vector<double> turns, crossings;
  if (memory_.hysteresis())
    add_zeros(
        grid, [&](double t) { return slope_of(step, kBeam, t); }, turns);
  if (memory_.relaxation()) {
    const double T_g = memory_.glass_transition();
    add_zeros(
        grid, [&](double t) { return patches(t) - T_g; }, crossings);
  }
  std::vector<double> cuts = turns;
  cuts.insert(cuts.end(), crossings.begin(), crossings.end());
  if (moved > kWidestStep) {
    cuts.insert(cuts.end(), grid.begin() + 1, grid.end());
  } else {
    cuts.push_back(step.end);
  }
  std::ranges::sort(cuts);
  for (const double t : cuts) {
    if (t <= times_.back()) continue;
    advance(step, times_.back(), t, 0);
    if (std::ranges::binary_search(crossings, t)) breaks_.back() = 1;
  }
}

void MemoryTrajectory::advance(const OdeStep& step, double from, double to,
                               int depth) {
  constexpr int kDeepest = 30;
  const double before = value_of(step, kPzt, from);
  const double after = value_of(step, kPzt, to);
  UnitMemory next = memory_;
  next.advance_patches(before, after, to - from);
  const double change = next.state(after).glass_offset - glass_.values().back();
  if (std::abs(change) > kWidestGlass && depth < kDeepest) {
    const double middle = 0.5 * (from + to);
    advance(step, from, middle, depth + 1);
    advance(step, middle, to, depth + 1);
    return;
  }
  memory_ = next;
  add_knot(to, value_of(step, kBeam, to), after);
}

void MemoryTrajectory::finish() {
  if (times_.size() == 1) {  // a run of one sample
    times_.push_back(times_.back() + 1);
    beam_.push_back(beam_.back());
    breaks_.push_back(1);
    if (!plays_.empty()) plays_.push_back(plays_.back());
    hysteresis_.push_back(hysteresis_.back());
    glass_.add(glass_.values().back());
    decades_.add(decades_.values().back());
  }
  glass_.finish(times_, breaks_);
  decades_.finish(times_, breaks_);
}

void MemoryTrajectory::sample(std::span<const double> times,
                              std::span<const double> beam,
                              std::span<MemoryState> states) const {
  std::size_t k =
      times.empty() ? 0 : interval_of(times_, times[0], times_.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    k = interval_of(times_, times[i], k);
    states[i].glass_offset = glass_.at(times_, k, times[i]);
    states[i].hysteresis = hysteresis(k, beam[i]);
    states[i].decades = decades_.at(times_, k, times[i]);
  }
}

MemoryState MemoryTrajectory::at(double t, double beam) const {
  MemoryState state;
  sample({&t, 1}, {&beam, 1}, {&state, 1});
  return state;
}

double MemoryTrajectory::hysteresis(std::size_t k, double beam) const {
  return memory_.hysteresis() ? memory_.hysteresis()->share(plays_[k], beam)
                              : 0;
}

MemoryState MemoryTrajectory::knot(std::size_t k) const {
  return {glass_.values()[k], hysteresis_[k], decades_.values()[k]};
}

MemoryRange MemoryTrajectory::range(double low, double high) const {
  const auto [soft, stiff] = std::ranges::minmax_element(hysteresis_);
  const auto [young, old] = std::ranges::minmax_element(decades_.values());
  const std::vector<double>& glass = glass_.values();
  bool found = false;
  double least = glass.front(), most = glass.front();
  for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
    if (std::max(beam_[k], beam_[k + 1]) < low ||
        std::min(beam_[k], beam_[k + 1]) > high)
      continue;
    const auto [a, b] = std::minmax(glass[k], glass[k + 1]);
    least = found ? std::min(least, a) : a;
    most = found ? std::max(most, b) : b;
    found = true;
  }
  return {{least, *soft, *young}, {most, *stiff, *old}};
}

}  // namespace beamgyro
