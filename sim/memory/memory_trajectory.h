// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/memory/smooth_course.h"
#include "sim/memory/unit_memory.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {

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
