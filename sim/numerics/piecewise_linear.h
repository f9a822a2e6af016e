// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sim/numerics/timeline.h"

namespace beamgyro::internal {

/// A straight line between two times.
struct LinearStretch {
  double start, end;              // [s]
  double start_value, end_value;  // in the unit of the function

  double at(double t) const;
};

/// A function of time that is linear between its points and held before the
/// first and after the last. Two points at the same time are a jump.
class PiecewiseLinear {
 public:
  /// Throws std::invalid_argument that names the first bad point:
  /// - there is no point, or the numbers of times and values differ;
  /// - a number is not finite;
  /// - a time decreases, or three points have the same time.
  PiecewiseLinear(std::vector<double> time, std::vector<double> value);

  static PiecewiseLinear constant(double value);

  double value(double t) const;         // the right-hand limit at a jump
  double value_before(double t) const;  // the left-hand limit at a jump

  /// Returns value() at non-decreasing times, in one pass.
  std::vector<double> sample(std::span<const double> times) const;

  /// Returns the line between two times that have no point between them: from
  /// the right-hand limit at `start` to the left-hand limit at `end`.
  LinearStretch stretch(double start, double end) const;

  /// Returns the times at which the value or the slope may jump: those of the
  /// points, each once.
  std::vector<Border> borders() const;

  /// The points as given.
  const std::vector<double>& times() const { return time_; }
  const std::vector<double>& values() const { return value_; }

 private:
  double between(std::size_t next, double t) const;

  std::vector<double> time_;
  std::vector<double> value_;
};

}  // namespace beamgyro::internal
