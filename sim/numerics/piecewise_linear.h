// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace beamgyro {

/// A function of time that is linear between its points and held before the
/// first and after the last. Two points at the same time are a jump.
class PiecewiseLinear {
 public:
  /// Throws std::invalid_argument that names the first bad point: none at all,
  /// unequal numbers of times and values, a number that is not finite, a time
  /// that decreases, a third point at one time.
  PiecewiseLinear(std::vector<double> time, std::vector<double> value);

  static PiecewiseLinear constant(double value);

  double value(double t) const;         // the right-hand limit at a jump
  double value_before(double t) const;  // the left-hand limit at a jump

  /// value() at non-decreasing times, in one pass.
  std::vector<double> sample(std::span<const double> times) const;

  /// Where value or slope may jump: the times of the points, each once.
  std::vector<double> breakpoints() const;

 private:
  double between(std::size_t next, double t) const;

  std::vector<double> time_;
  std::vector<double> value_;
};

}  // namespace beamgyro
