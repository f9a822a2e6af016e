// SPDX-License-Identifier: MIT
#include "compensation/noise_coefficients.h"

#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace beamgyro {
namespace {

constexpr std::size_t kLeastClusters = 9;
constexpr std::size_t kLeastPoints = 5;
constexpr double kLeastSignificance = 3.0;  // [-]
constexpr int kTerms = 5;
enum Term { kQuantisation, kAngleWalk, kFlicker, kRateWalk, kRamp };

/// Variance of each term at tau for a coefficient of one.
std::array<double, kTerms> unit_variances(double tau) {
  return {3.0 / (tau * tau), 1.0 / tau,
          2.0 * std::numbers::ln2 / std::numbers::pi, tau / 3.0,
          tau * tau / 2.0};
}

struct Fit {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(kTerms);  // of coefficients
  Eigen::VectorXd uncertainties = Eigen::VectorXd::Zero(kTerms);  // 1-sigma
};

/// Best fit without a negative square: five terms have 31 subsets, so all of
/// them are tried. Rows are weighted to an uncertainty of one.
Fit non_negative_fit(const Eigen::MatrixXd& terms,
                     const Eigen::VectorXd& target) {
  Fit best;
  double least = std::numeric_limits<double>::infinity();
  for (int subset = 1; subset < 1 << kTerms; ++subset) {
    std::vector<int> used;
    for (int term = 0; term < kTerms; ++term) {
      if ((subset >> term & 1) != 0) {
        used.push_back(term);
      }
    }
    const Eigen::MatrixXd columns = terms(Eigen::all, used);
    const Eigen::VectorXd scale = columns.colwise().norm().transpose();
    const Eigen::MatrixXd scaled = columns * scale.cwiseInverse().asDiagonal();
    const Eigen::VectorXd found = scaled.colPivHouseholderQr().solve(target);
    const double misfit = (scaled * found - target).squaredNorm();
    if ((found.array() >= 0.0).all() && misfit < least) {
      least = misfit;
      const Eigen::MatrixXd covariance =
          (scaled.transpose() * scaled).inverse();
      best = {};
      best.squares(used) = found.cwiseQuotient(scale);
      best.uncertainties(used) =
          covariance.diagonal().cwiseSqrt().cwiseQuotient(scale);
    }
  }
  return best;
}

bool is_usable(const AllanPoint& point) {
  return point.clusters >= kLeastClusters && point.deviation > 0.0;
}

std::vector<AllanPoint> usable(const std::vector<AllanPoint>& points) {
  std::vector<AllanPoint> used;
  for (const AllanPoint& point : points) {
    if (!std::isfinite(point.deviation)) {
      throw std::invalid_argument(fmt::format(
          "deviation at {} s: {}, must be finite", point.tau, point.deviation));
    }
    if (is_usable(point)) {
      used.push_back(point);
    }
  }
  if (used.size() < kLeastPoints) {
    throw std::invalid_argument(fmt::format(
        "Allan curve: {} points with {} clusters, must be at least {}",
        used.size(), kLeastClusters, kLeastPoints));
  }
  std::ranges::sort(used, {}, &AllanPoint::tau);
  return used;
}

std::optional<double> lowest_deviation(const std::vector<AllanPoint>& used) {
  const auto lowest =
      std::ranges::min_element(used, {}, &AllanPoint::deviation);
  return lowest == used.end() - 1 ? std::nullopt
                                  : std::optional(lowest->deviation);
}

}  // namespace

bool has_noise_coefficients(const std::vector<AllanPoint>& points) {
  return std::ranges::count_if(points, is_usable) >=
         static_cast<std::ptrdiff_t>(kLeastPoints);
}

NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points) {
  const std::vector<AllanPoint> used = usable(points);
  const auto rows = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd terms(rows, kTerms);
  Eigen::VectorXd target(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const AllanPoint& point = used[static_cast<std::size_t>(i)];
    const double variance = point.deviation * point.deviation;
    const double weight = 1.0 / (2.0 * relative_uncertainty(point) * variance);
    const auto units = unit_variances(point.tau);
    for (int term = 0; term < kTerms; ++term) {
      terms(i, term) = weight * units[static_cast<std::size_t>(term)];
    }
    target(i) = weight * variance;
  }
  const Fit fit = non_negative_fit(terms, target);
  const auto coefficient = [&fit](Term term, double unit) {
    const double square = fit.squares(term);
    return square > kLeastSignificance * fit.uncertainties(term)
               ? std::optional(unit * std::sqrt(square))
               : std::nullopt;
  };
  const auto lowest = lowest_deviation(used);
  const double flicker_level =
      std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
  return {.angle_random_walk = coefficient(kAngleWalk, 60.0),
          .bias_instability =
              lowest ? std::optional(3600.0 * *lowest / flicker_level)
                     : std::nullopt,
          .rate_random_walk = coefficient(kRateWalk, 3600.0 * 60.0),
          .angle_quantisation = coefficient(kQuantisation, 1.0),
          .rate_ramp = coefficient(kRamp, 3600.0 * 3600.0)};
}

std::string table(const NoiseCoefficients& coefficients) {
  std::string text;
  const auto line = [&text](const char* name, std::optional<double> value,
                            const char* unit) {
    text += fmt::format("{:<22}{:>12} {}\n", name,
                        value ? fmt::format("{:.4g}", *value) : "-",
                        value ? unit : "");
  };
  line("angle random walk N", coefficients.angle_random_walk, "deg/sqrt(h)");
  line("bias instability B", coefficients.bias_instability, "deg/h");
  line("rate random walk K", coefficients.rate_random_walk, "deg/h/sqrt(h)");
  line("angle quantisation Q", coefficients.angle_quantisation, "deg");
  line("rate ramp R", coefficients.rate_ramp, "deg/h/h");
  return text;
}

}  // namespace beamgyro
