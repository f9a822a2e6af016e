// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

enum class SplineEnd {
  kNatural,   // s'' = 0 at both ends
  kNotAKnot,  // s''' continuous at the second and the last but one knot
};

/// Piecewise cubic with two continuous derivatives, given by its values y_k and
/// second derivatives M_k at the knots x_k. With h = x_{k+1} - x_k, a =
/// (x_{k+1} - x) / h, b = 1 - a:
///
///   s(x) = a y_k + b y_{k+1} + [(a^3 - a) M_k + (b^3 - b) M_{k+1}] h^2 / 6
///
/// Beyond the outer knots the outer cubics continue.
struct CubicSpline {
  Eigen::ArrayXd knots;               // [degC], increasing, at least 4
  Eigen::ArrayXd values;              // [deg/s]
  Eigen::ArrayXd second_derivatives;  // [deg/s/K^2]

  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;

  static constexpr const char* kKind = "spline";
  static constexpr InputUse kInputUse = InputUse::kOne;
  nlohmann::ordered_json parameters() const;
  static CubicSpline read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

/// Returns the spline on `knots` with the least sum of squared residuals at the
/// points (x, y). It passes through the points when there is one for each knot.
/// Throws std::invalid_argument for fewer than 4 knots, knots that do not
/// increase or points that do not determine the values at all knots.
CubicSpline fit_cubic_spline(const Eigen::Ref<const Eigen::ArrayXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             const Eigen::ArrayXd& knots, SplineEnd end);

/// Chooses knots from the data. Points with a gap of more than spacing / 4
/// between neighbours form separate groups. A group no wider than spacing / 2
/// (a soak) gets one knot at its mean. A wider one (a ramp) gets knots from end
/// to end, in equal steps no longer than `spacing` [K].
Eigen::ArrayXd spline_knots(const Eigen::Ref<const Eigen::ArrayXd>& x,
                            double spacing);

}  // namespace beamgyro::internal
