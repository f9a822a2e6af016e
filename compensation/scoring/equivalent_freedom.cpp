// SPDX-License-Identifier: MIT
#include "compensation/scoring/equivalent_freedom.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>

#include "compensation/scoring/difference_covariance.h"

namespace beamgyro::internal {
namespace {

constexpr double kTail = 0.025;       // on either side of a 95 % interval
constexpr double kSmallLength = 8.0;  // [samples]
constexpr double kSmallestFreedom = 0.5;
constexpr double kLargestFreedom = 1e9;

using Autocovariance = std::function<double(double)>;

/// |t|^power, times ln |t| if `power` is even.
double power_law(double t, int power) {
  t = std::abs(t);
  if (t == 0.0) return 0.0;
  return std::pow(t, power) * (power % 2 == 0 ? std::log(t) : 1.0);
}

/// Of angles, to a factor: whose rate is noise of that type.
Autocovariance of_angles(NoiseType type) {
  if (type == NoiseType::kQuantisation)
    return [](double t) { return t == 0.0 ? 1.0 : 0.0; };
  if (type == NoiseType::kAngleFlicker)
    return [](double t) {
      return power_law(t + 1.0, 2) + power_law(t - 1.0, 2) -
             2.0 * power_law(t, 2);
    };
  const int power = 1 - static_cast<int>(type);
  return [power](double t) { return power_law(t, power); };
}

/// Of means of m neighbouring angles.
Autocovariance of_mean_angles(NoiseType type, double m) {
  const int power = 3 - static_cast<int>(type);
  return [power, m](double t) {
    return power_law(t + m, power) + power_law(t - m, power) -
           2.0 * power_law(t, power);
  };
}

NoiseType nearest_stationary(NoiseType type, int order) {
  return std::max(type,
                  order == 3 ? NoiseType::kRandomRun : NoiseType::kRandomWalk);
}

/// Of differences that begin every m samples.
double freedom_of_strides(const Autocovariance& r, int order, double m,
                          double samples) {
  // In units of m the differences are of length one.
  const double starts = std::floor(samples / m) - order + 1.0;
  const Autocovariance scaled = [&](double t) { return r(t * m); };
  const AngleDifferences all{order, 1.0, starts};
  const double variance_of_one = variance_of_difference(scaled, all);
  return variance_of_one * variance_of_one /
         pair_means(scaled, all, all).squares;
}

/// Where m is small totdev is hardly better than oadev, of freedom
/// `overlapping`, and the table does not hold.
double freedom_of_totdev(NoiseType type, double m, double samples,
                         double overlapping) {
  if (type > NoiseType::kWhite) {
    // The squares add up to 6 samples + 8 m. 2 * 36 * 35/18 * samples is their
    // variance without, 64 m^2 that of the first and of the last angle, which
    // twice m of the reflected differences hold.
    return 2.0 * std::pow(6.0 * samples + 8.0 * m, 2) /
           (140.0 * samples + 64.0 * m * m);
  }
  const double ratio = samples / m;
  const double table = type == NoiseType::kWhite     ? 1.5 * ratio
                       : type == NoiseType::kFlicker ? 1.17 * ratio - 0.22
                                                     : 0.93 * ratio - 0.36;
  return m > kSmallLength ? table : std::min(table, overlapping);
}

double freedom_of(DeviationKind kind, NoiseType type, double m,
                  double samples) {
  const int order = order_of(kind);
  if (kind == DeviationKind::kAdev || kind == DeviationKind::kHdev)
    return freedom_of_strides(of_angles(type), order, m, samples);
  const bool is_mean = kind == DeviationKind::kMdev && m > 1.0;
  const Autocovariance r = is_mean ? of_mean_angles(type, m) : of_angles(type);
  const double last = is_mean ? 3.0 * m - 1.0 : order * m;
  const AngleDifferences all{order, m, samples - last + 1.0};
  const double variance_of_one = variance_of_difference(r, all);
  const double found =
      variance_of_one * variance_of_one / pair_means(r, all, all).squares;
  return kind == DeviationKind::kTotdev
             ? freedom_of_totdev(type, m, samples, found)
             : found;
}

}  // namespace

double equivalent_freedom(DeviationKind kind, NoiseType type, double m,
                          double samples) {
  type = nearest_stationary(type, order_of(kind));
  return std::clamp(freedom_of(kind, type, m, samples), kSmallestFreedom,
                    kLargestFreedom);
}

ConfidenceInterval confidence_interval(double deviation, double freedom) {
  const boost::math::chi_squared distribution(
      std::clamp(freedom, kSmallestFreedom, kLargestFreedom));
  const auto bound = [&](double quantile) {
    return deviation * std::sqrt(distribution.degrees_of_freedom() / quantile);
  };
  return {bound(quantile(complement(distribution, kTail))),
          bound(quantile(distribution, kTail))};
}

double expected_ratio(DeviationKind kind, NoiseType type, double m,
                      double samples) {
  if (kind != DeviationKind::kTotdev || type == NoiseType::kWhite) return 1.0;
  const double slope = type > NoiseType::kWhite      ? 4.0 / 3.0
                       : type == NoiseType::kFlicker ? -0.481
                                                     : -0.75;
  return 1.0 + slope * m / samples;
}

}  // namespace beamgyro::internal
