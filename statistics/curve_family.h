// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

// How much the curves of several units move over temperature, how unlike smooth
// curves they are, and how unlike each other. docs/reference/curves.md
// has the definitions. No function checks its arguments: temperatures increase
// strictly, every value is finite.
namespace beamgyro::internal {

/// Curves of several units over the same m temperatures.
struct CurveFamily {
  Eigen::VectorXd temperature;  // m [K or degC]
  Eigen::MatrixXd curves;       // a row each unit, units x m
};

/// Returns the part at temperatures of `low` to `high`, both included, which
/// may have none.
CurveFamily within(const CurveFamily& family, double low, double high);

/// Returns each curve less its value at a temperature between the first and the
/// last of two or more, on the straight line between the two nearest.
CurveFamily zeroed_at(const CurveFamily& family, double temperature);

/// Returns the curves with each value at the nearest multiple of `step` > 0.
CurveFamily rounded_to(const CurveFamily& family, double step);

/// Half the width of the second difference of `kink`, in kelvin.
inline constexpr double kKinkReach = 3.0;

inline constexpr std::array<int, 3> kLeftByDegrees = {1, 3, 5};

/// Figures of one curve b_k = b(T_k). What has no value is NaN: shares and kink
/// of a curve that is flat, the kink over less than 2 kKinkReach.
struct CurveFigures {
  double peak_to_peak;  // max b_k - min b_k
  /// 1 - R^2 of the least-squares polynomials of kLeftByDegrees: the variance
  /// about the polynomial over that about the mean, in [0, 1].
  std::array<double, kLeftByDegrees.size()> left;
  /// max_k |b(T_k + 3 K) - 2 b(T_k) + b(T_k - 3 K)| / peak_to_peak, over the
  /// T_k with 3 K on either side; b on straight lines between temperatures.
  double kink;
};

/// Fewer leave a quintic, which passes through any six points, no share that
/// says anything.
inline constexpr Eigen::Index kFewestTemperatures = 8;

/// Returns the figures of each unit over kFewestTemperatures or more.
std::vector<CurveFigures> curve_figures(const CurveFamily& family);

/// How a family varies. With c_i(T) = b_i(T) - mean over T, m(T) the mean of
/// c_i over the n units, and d_i = c_i - m.
struct CurveModes {
  /// n sum_T m^2 / sum_i sum_T c_i^2; NaN when every curve is flat.
  double mean_curve_share;
  /// Eigenvalues of sum_i d_i d_i^T over their sum, the largest first, at most
  /// kMostComponents; none when all d_i are 0.
  std::vector<double> component_shares;
};

inline constexpr std::size_t kMostComponents = 5;

CurveModes curve_modes(const CurveFamily& family);

}  // namespace beamgyro::internal
