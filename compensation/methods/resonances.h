// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "compensation/methods/method.h"
#include "compensation/models/resonance_curve.h"

namespace beamgyro::internal {

/// Table [resonances]. The inputs are the temperature, then low-passes of it
/// and the time since power-on, which tell how far the beam is behind, and last
/// the quadrature or a low-pass of it. Quadrature is also taken of the rows
/// that steady_K_per_min leaves out. Beside the resonances the bias is straight
/// lines: between soaks, or between even knots, fitted to all rows of training.
struct ResonancesSpec {
  int most = 8;                          // resonances, 0 ... 8
  int degree = 3;                        // of the smooth part of the quadrature
  double beam_sigma_K = 0.5;             // [K], error of the beam's temperature
  double quadrature_noise = 0.002;       // [deg/s], of a sample, 1-sigma
  std::optional<double> knot_spacing_K;  // [K]; absent: between soaks

  static constexpr const char* kName = "resonances";
  static constexpr InputRule kInputRule = InputRule::kNamed;
  using Function = ResonanceCurve;
  static ResonancesSpec read(MethodSource& source);
  std::string method_name() const { return "resonances found in quadrature"; }
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
