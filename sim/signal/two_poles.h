// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

/// A stretch of time as two poles w see it.
struct FilterStretch {
  double x;           // w h
  double decay;       // e^-x
  double mean_decay;  // (1 - e^-x) / x
};

/// `corner` is w [rad/s], `duration` is h >= 0 [s].
FilterStretch filter_stretch(double corner, double duration);

/// The state of two equal real poles w in a row,
///   y_1' = w (u - y_1),   y_2' = w (y_1 - y_2),
/// moved on exactly.
struct TwoPoles {
  double first = 0, second = 0;  // y_1, y_2, in the unit of u

  /// Over a stretch in which u runs from `input` to `input + rise` along a
  /// straight line.
  void advance(const FilterStretch& stretch, double input, double rise);

  /// Over `duration` [s] of u = (a + b t)^2, with poles at `corner` [rad/s].
  void advance_square(double corner, double a, double b, double duration);
};

}  // namespace beamgyro::internal
