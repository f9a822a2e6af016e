// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/cubic_spline.h"

namespace beamgyro::internal {

/// Table [spline].
struct SplineSpec {
  double knot_spacing_K = 5.0;  // [K], see spline_knots()
  SplineEnd end = SplineEnd::kNotAKnot;

  static constexpr const char* kName = "spline";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = CubicSpline;
  static SplineSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
