// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/memory/unit_memory.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {

/// A quantity over time that is known at knots, with cubics between them whose
/// slopes come from the parabola through three knots. At a break the slope may
/// jump. Value is a number or an Eigen array.
template <class Value>
class SmoothCourse {
 public:
  void add(const Value& value) { values_.push_back(value); }
  const std::vector<Value>& values() const { return values_; }

  /// Call once, after the last add(): one time [s] and one mark of a break for
  /// each value.
  void finish(const std::vector<double>& times,
              const std::vector<char>& breaks) {
    const std::size_t count = values_.size();
    after_.assign(count, values_.front() - values_.front());
    before_ = after_;
    for (std::size_t k = 0; k < count; ++k) {
      const bool has_left = k > 0, has_right = k + 1 < count;
      if (has_left && has_right && !breaks[k]) {
        after_[k] = before_[k] = slope(times, k - 1, k);
        continue;
      }
      if (has_right) {
        const bool is_alone = k + 2 >= count || breaks[k + 1];
        after_[k] = is_alone ? secant(times, k)
                             : 2 * secant(times, k) - slope(times, k, k + 1);
      }
      if (has_left) {
        const bool is_alone = k < 2 || breaks[k - 1];
        before_[k] =
            is_alone ? secant(times, k - 1)
                     : 2 * secant(times, k - 1) - slope(times, k - 2, k - 1);
      }
    }
  }

  /// The value at `t` [s] between knots k and k + 1.
  Value at(const std::vector<double>& times, std::size_t k, double t) const {
    const double h = times[k + 1] - times[k], s = (t - times[k]) / h;
    const Value rise = values_[k + 1] - values_[k];
    const Value first = h * after_[k], last = h * before_[k + 1];
    return values_[k] + s * (first + s * (3 * rise - 2 * first - last +
                                          s * (first + last - 2 * rise)));
  }

 private:
  Value secant(const std::vector<double>& times, std::size_t k) const {
    return (values_[k + 1] - values_[k]) / (times[k + 1] - times[k]);
  }
  // At `k`, of the parabola through left, left + 1 = k, k + 1.
  Value slope(const std::vector<double>& times, std::size_t left,
              std::size_t k) const {
    const double a = times[k] - times[left], b = times[k + 1] - times[k];
    return (b * secant(times, left) + a * secant(times, k)) / (a + b);
  }

  std::vector<Value> values_, after_, before_;
};

/// The index k with times[k] <= t < times[k + 1], or that of the first or last
/// interval; `from` is a first guess. There are at least two times.
inline std::size_t interval_of(const std::vector<double>& times, double t,
                               std::size_t from) {
  const std::size_t last = times.size() - 2;
  std::size_t k = std::min(from, last);
  if (t < times[k])
    k = static_cast<std::size_t>(
        std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (t < times[k] && k > 0) --k;
  while (k < last && t >= times[k + 1]) ++k;
  return std::min(k, last);
}

struct MemoryRange {
  MemoryState low, high;
};

/// The memory states of one unit over a run, driven by the solution of the
/// thermal network. They are kept at knots, where
/// - the beam turns: its hysteresis is exact between two knots;
/// - the patches cross T_g;
/// - a temperature has changed by kWidestStep;
/// - T_f - T_f,ref or the age bend, so that the middle of two intervals between
///   knots is off the straight line by kGlassBend or kDecadesBend.
/// Between knots, T_f - T_f,ref and the age are cubics.
class MemoryTrajectory {
 public:
  static constexpr double kWidestStep = 1;    // [K]
  static constexpr double kGlassBend = 0.01;  // [K]
  static constexpr double kDecadesBend = 3e-4;

  explicit MemoryTrajectory(const UnitMemory& start);

  /// Takes the states and steps of integrate_temperatures(). The trajectory
  /// must outlive it and stay where it is.
  ThermalSink sink();
  /// Call once after the integration.
  void finish();

  /// Writes the states at increasing `times` [s] with the beam at the
  /// temperatures `beam` [K] of the same solution.
  void sample(std::span<const double> times, std::span<const double> beam,
              std::span<MemoryState> states) const;
  MemoryState at(double t, double beam) const;

  /// The hysteresis between knots k and k + 1 with the beam at `beam` [K]; 0
  /// for a unit without.
  double hysteresis(std::size_t k, double beam) const;

  /// The extremes of the states while the beam is within [low, high] [K], and
  /// the first state where it never is. The ranges of hysteresis and age are
  /// those of the whole run.
  MemoryRange range(double low, double high) const;

  const std::vector<double>& times() const { return times_; }  // [s]
  const std::vector<double>& beam() const { return beam_; }    // [K]
  const std::vector<char>& breaks() const { return breaks_; }
  MemoryState knot(std::size_t k) const;

 private:
  void begin(double t, const Eigen::VectorXd& y);
  void take(const OdeStep& step);
  void advance(const OdeStep& step, double end);
  bool add_one(const OdeStep& step, double from, double to);
  bool add_two(const OdeStep& step, double from, double to);
  double bend_of(const UnitMemory& middle, const UnitMemory& last,
                 const std::array<double, 3>& patches) const;
  void add_knot(double t, double beam, double patches);
  void adapt_width();

  UnitMemory memory_;
  // What the last intervals allow for the next two together [s]; 0: unknown.
  double width_ = 0;
  std::vector<double> times_, beam_;
  std::vector<char> breaks_;  // the slope of T_f - T_f,ref jumps
  std::vector<PlayOperators::States> plays_;
  std::vector<double> hysteresis_;
  SmoothCourse<double> glass_, decades_;
  std::vector<double> least_glass_, most_glass_;  // of each interval
};

}  // namespace beamgyro::internal
