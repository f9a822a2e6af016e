// SPDX-License-Identifier: MIT
#include "statistics/curve_family.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/eigenvalues.h"

namespace beamgyro::internal {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The value at a temperature is this mix of two neighbouring ones.
struct Between {
  Eigen::Index below;
  double share;  // of the one above

  double of(const Eigen::VectorXd& curve) const {
    return curve(below) + share * (curve(below + 1) - curve(below));
  }
};

Between between(const Eigen::VectorXd& temperature, double at) {
  const auto* const begin = temperature.data();
  const auto* const end = begin + temperature.size();
  const Eigen::Index above = std::clamp<Eigen::Index>(
      std::lower_bound(begin, end, at) - begin, 1, temperature.size() - 1);
  const double low = temperature(above - 1);
  return {above - 1, (at - low) / (temperature(above) - low)};
}

/// Returns polynomials of degree 0 to `degree`, a column each, whose products
/// summed over the temperatures are 1 with themselves and 0 with each other.
Eigen::MatrixXd orthonormal_polynomials(const Eigen::VectorXd& temperature,
                                        int degree) {
  const double low = temperature.minCoeff();
  const double half = 0.5 * (temperature.maxCoeff() - low);
  const Eigen::ArrayXd x = (temperature.array() - low) / half - 1;
  Eigen::MatrixXd columns(temperature.size(), degree + 1);
  columns.col(0).setConstant(
      1 / std::sqrt(static_cast<double>(temperature.size())));
  for (int k = 1; k <= degree; ++k) {
    Eigen::VectorXd next = (x * columns.col(k - 1).array()).matrix();
    // Once leaves rounding, twice does not.
    for (int pass = 0; pass < 2; ++pass)
      next -= columns.leftCols(k) * (columns.leftCols(k).transpose() * next);
    columns.col(k) = next.normalized();
  }
  return columns;
}

/// Returns shares of the variance of a curve that is not flat.
std::array<double, kLeftByDegrees.size()> left_by_polynomials(
    const Eigen::VectorXd& curve, const Eigen::MatrixXd& polynomials) {
  std::array<double, kLeftByDegrees.size()> left{};
  Eigen::VectorXd rest = curve.array() - curve.mean();
  const double all = rest.squaredNorm();
  int degree = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (; degree < kLeftByDegrees[i]; ++degree)
      rest -=
          polynomials.col(degree + 1) * polynomials.col(degree + 1).dot(rest);
    left[i] = rest.squaredNorm() / all;
  }
  return left;
}

/// Where the second differences of a curve are taken.
struct SecondDifference {
  Eigen::Index middle;
  Between below, above;
};

std::vector<SecondDifference> second_differences(
    const Eigen::VectorXd& temperature) {
  // A temperature of a grid may miss the end by a rounding.
  constexpr double kRounding = 1e-9;  // [K]
  std::vector<SecondDifference> places;
  const double first = temperature(0) - kRounding;
  const double last = temperature(temperature.size() - 1) + kRounding;
  for (Eigen::Index k = 0; k < temperature.size(); ++k) {
    const double low = temperature(k) - kKinkReach;
    const double high = temperature(k) + kKinkReach;
    if (low >= first && high <= last)
      places.push_back(
          {k, between(temperature, low), between(temperature, high)});
  }
  return places;
}

double largest(const std::vector<SecondDifference>& places,
               const Eigen::VectorXd& curve) {
  double most = places.empty() ? kNone : 0.0;
  for (const SecondDifference& place : places)
    most = std::max(most,
                    std::abs(place.below.of(curve) - 2 * curve(place.middle) +
                             place.above.of(curve)));
  return most;
}

}  // namespace

CurveFamily within(const CurveFamily& family, double low, double high) {
  const auto* const begin = family.temperature.data();
  const auto* const end = begin + family.temperature.size();
  const Eigen::Index first = std::lower_bound(begin, end, low) - begin;
  const Eigen::Index count = std::upper_bound(begin, end, high) - begin - first;
  if (count <= 0) return {{}, Eigen::MatrixXd(family.curves.rows(), 0)};
  return {family.temperature.segment(first, count),
          family.curves.middleCols(first, count)};
}

CurveFamily zeroed_at(const CurveFamily& family, double temperature) {
  const Between place = between(family.temperature, temperature);
  CurveFamily zeroed = family;
  for (Eigen::Index i = 0; i < zeroed.curves.rows(); ++i)
    zeroed.curves.row(i).array() -= place.of(family.curves.row(i));
  return zeroed;
}

CurveFamily rounded_to(const CurveFamily& family, double step) {
  return {family.temperature, step * (family.curves / step).array().round()};
}

std::vector<CurveFigures> curve_figures(const CurveFamily& family) {
  const Eigen::MatrixXd polynomials =
      orthonormal_polynomials(family.temperature, kLeftByDegrees.back());
  const std::vector<SecondDifference> places =
      second_differences(family.temperature);
  std::vector<CurveFigures> figures;
  for (Eigen::Index i = 0; i < family.curves.rows(); ++i) {
    const Eigen::VectorXd curve = family.curves.row(i);
    CurveFigures one{curve.maxCoeff() - curve.minCoeff(), {}, kNone};
    one.left.fill(kNone);
    if (one.peak_to_peak > 0) {
      one.left = left_by_polynomials(curve, polynomials);
      one.kink = largest(places, curve) / one.peak_to_peak;
    }
    figures.push_back(one);
  }
  return figures;
}

CurveModes curve_modes(const CurveFamily& family) {
  Eigen::MatrixXd centred =
      family.curves.colwise() - family.curves.rowwise().mean();
  const double all = centred.squaredNorm();
  const Eigen::RowVectorXd mean = centred.colwise().mean();
  CurveModes modes{kNone, {}};
  if (!(all > 0)) return modes;
  const auto units = static_cast<double>(centred.rows());
  modes.mean_curve_share = units * mean.squaredNorm() / all;
  centred.rowwise() -= mean;
  const double varying = centred.squaredNorm();
  // Of a family of equal curves rounding is left.
  if (!(varying > 1e-24 * all)) return modes;
  const bool is_wide = centred.rows() < centred.cols();
  const Eigen::MatrixXd products =
      is_wide ? Eigen::MatrixXd(centred * centred.transpose())
              : Eigen::MatrixXd(centred.transpose() * centred);
  const Eigen::VectorXd values = symmetric_eigen(products).values;
  const auto count = std::min<Eigen::Index>(kMostComponents, values.size());
  for (Eigen::Index k = 1; k <= count; ++k)
    modes.component_shares.push_back(std::max(0.0, values(values.size() - k)) /
                                     varying);
  return modes;
}

}  // namespace beamgyro::internal
