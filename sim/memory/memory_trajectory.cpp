// SPDX-License-Identifier: MIT
#include "sim/memory/memory_trajectory.h"

#include <cmath>

namespace beamgyro::internal {
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

// How much wider the next two intervals may be than two with this bend, of what
// is allowed: it grows with the square of the width.
double growth(double bend) {
  constexpr double kMost = 2, kSafety = 0.7;
  return std::clamp(kSafety / std::sqrt(std::max(bend, 1e-9)), 0.5, kMost);
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
  width_ = 0;
}

void MemoryTrajectory::take(const OdeStep& step) {
  const auto beam = [&](double t) { return value_of(step, kBeam, t); };
  const auto patches = [&](double t) { return value_of(step, kPzt, t); };
  constexpr double kNear = 2, kMargin = 0.1;  // [K]
  const double moved =
      std::max(std::abs(beam(step.end) - beam(step.begin)),
               std::abs(patches(step.end) - patches(step.begin)));
  const int parts =
      std::max(4, static_cast<int>(std::ceil(moved / kWidestStep)));
  std::vector<double> grid;
  grid.reserve(static_cast<std::size_t>(parts) + 1);
  for (int i = 0; i <= parts; ++i)
    grid.push_back(std::lerp(step.begin, step.end, double(i) / parts));

  std::vector<double> turns, crossings;
  if (memory_.hysteresis())
    add_zeros(
        grid, [&](double t) { return slope_of(step, kBeam, t); }, turns);
  const double T_g = memory_.glass_transition();
  if (memory_.relaxation() &&
      std::abs(patches(step.end) - T_g) <= kNear * moved + kMargin) {
    add_zeros(
        grid, [&](double t) { return patches(t) - T_g; }, crossings);
  }
  if (turns.empty() && crossings.empty()) return advance(step, step.end);
  std::vector<double> cuts = turns;
  cuts.insert(cuts.end(), crossings.begin(), crossings.end());
  cuts.push_back(step.end);
  std::ranges::sort(cuts);
  for (const double t : cuts) {
    if (t <= times_.back()) continue;
    advance(step, t);
    if (std::ranges::binary_search(crossings, t)) breaks_.back() = 1;
  }
}

void MemoryTrajectory::advance(const OdeStep& step, double end) {
  while (times_.back() < end) {
    const double from = times_.back();
    // No interval is left that is much shorter than its neighbours.
    const double to =
        width_ > 0 && end - from > 1.25 * width_ ? from + width_ : end;
    if (add_one(step, from, to)) continue;
    if (!add_two(step, from, to)) width_ = 0.5 * (to - from);
  }
}

// Adds one knot, where the last ones say that no more are needed.
bool MemoryTrajectory::add_one(const OdeStep& step, double from, double to) {
  constexpr double kNarrow = 0.3;  // [K]
  const double beam = value_of(step, kBeam, to);
  const double before = value_of(step, kPzt, from);
  const double after = value_of(step, kPzt, to);
  if (!(to - from <= 0.5 * width_ && std::abs(beam - beam_.back()) < kNarrow &&
        std::abs(after - before) < kNarrow))
    return false;
  memory_.advance_patches(before, after, to - from);
  add_knot(to, beam, after);
  adapt_width();
  return true;
}

// Adds knots in the middle and at the end, unless the states bend too much.
bool MemoryTrajectory::add_two(const OdeStep& step, double from, double to) {
  constexpr double kShortest = 1e-6;  // [s]
  const std::array<double, 3> times = {from, 0.5 * (from + to), to};
  std::array<double, 3> beam, patches;
  for (std::size_t i = 0; i < times.size(); ++i) {
    beam[i] = value_of(step, kBeam, times[i]);
    patches[i] = value_of(step, kPzt, times[i]);
  }
  const bool is_short = to - from <= kShortest * std::max(1.0, to);
  for (std::size_t i = 0; i < 2 && !is_short; ++i) {
    if (std::abs(beam[i + 1] - beam[i]) > kWidestStep ||
        std::abs(patches[i + 1] - patches[i]) > kWidestStep)
      return false;
  }
  UnitMemory middle = memory_;
  middle.advance_patches(patches[0], patches[1], times[1] - from);
  UnitMemory last = middle;
  last.advance_patches(patches[1], patches[2], to - times[1]);
  const double bend = bend_of(middle, last, patches);
  if (bend > 1 && !is_short) return false;
  width_ = std::max(width_, growth(bend) * (to - from));
  memory_ = middle;
  add_knot(times[1], beam[1], patches[1]);
  memory_ = last;
  add_knot(to, beam[2], patches[2]);
  return true;
}

// How far the states at the middle are from the straight line between the last
// knot and `last`, over what is allowed; and what the bend of the temperature,
// which takes straight lines from knot to knot, does to T_f.
double MemoryTrajectory::bend_of(const UnitMemory& middle,
                                 const UnitMemory& last,
                                 const std::array<double, 3>& patches) const {
  constexpr double kError = 3e-4, kEquilibrium = 1e-3;  // of T_f [K]
  const MemoryState a = knot(times_.size() - 1);
  const MemoryState m = middle.state(patches[1]);
  const MemoryState b = last.state(patches[2]);
  const auto off_line = [](double left, double centre, double right) {
    return std::abs(centre - 0.5 * (left + right));
  };
  double bend =
      off_line(a.glass_offset, m.glass_offset, b.glass_offset) / kGlassBend;
  bend =
      std::max(bend, off_line(a.decades, m.decades, b.decades) / kDecadesBend);
  if (memory_.relaxation() &&
      std::max({std::abs(a.glass_offset), std::abs(m.glass_offset),
                std::abs(b.glass_offset)}) > kEquilibrium) {
    const double moved = std::abs(last.relaxation()->fictive_temperature() -
                                  memory_.relaxation()->fictive_temperature());
    const double off = 0.25 * off_line(patches[0], patches[1], patches[2]);
    const double share =
        std::min(1.0, moved / std::max(std::abs(patches[2] - patches[0]), off));
    if (off > 0) bend = std::max(bend, off * share / kError);
  }
  return bend;
}

// The last two intervals say how wide the next two may be.
void MemoryTrajectory::adapt_width() {
  const std::size_t last = times_.size() - 1;
  if (last < 2 || breaks_[last - 1] != 0) return;
  const double span = times_[last] - times_[last - 2];
  const double share = (times_[last - 1] - times_[last - 2]) / span;
  const MemoryState a = knot(last - 2), b = knot(last - 1), c = knot(last);
  const double bend =
      std::max(std::abs(b.glass_offset -
                        std::lerp(a.glass_offset, c.glass_offset, share)) /
                   kGlassBend,
               std::abs(b.decades - std::lerp(a.decades, c.decades, share)) /
                   kDecadesBend);
  const double width = growth(bend) * span;
  width_ = bend > 1 ? width : std::max(width_, width);
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
  for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
    double least = glass_.values()[k], most = least;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double t = std::lerp(times_[k], times_[k + 1], share);
      const double glass =
          share < 1 ? glass_.at(times_, k, t) : glass_.values()[k + 1];
      least = std::min(least, glass);
      most = std::max(most, glass);
    }
    least_glass_.push_back(least);
    most_glass_.push_back(most);
  }
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
  bool found = false;
  double least = glass_.values().front(), most = least;
  for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
    if (std::max(beam_[k], beam_[k + 1]) < low ||
        std::min(beam_[k], beam_[k + 1]) > high)
      continue;
    least = found ? std::min(least, least_glass_[k]) : least_glass_[k];
    most = found ? std::max(most, most_glass_[k]) : most_glass_[k];
    found = true;
  }
  return {{least, *soft, *young}, {most, *stiff, *old}};
}

}  // namespace beamgyro::internal
