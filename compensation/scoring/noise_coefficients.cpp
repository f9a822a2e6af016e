// SPDX-License-Identifier: MIT
#include "compensation/scoring/noise_coefficients.h"

#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kMostUncertain = 0.25;  // [-]
constexpr std::size_t kLeastPoints = 5;
constexpr Index kLeastFreedom = 2;  // points more than terms
constexpr double kPrice = 9.0;      // of a term or of a tau: 3 standard errors
constexpr int kMostRounds = 50;
constexpr double kSettled = 1e-9;  // [-]
constexpr int kTerms = 5;
enum Term { kQuantisation, kAngleWalk, kFlicker, kRateWalk, kRamp };

/// Variance of each term at tau for a coefficient of one.
std::array<double, kTerms> unit_variances(double tau) {
  return {3.0 / (tau * tau), 1.0 / tau,
          2.0 * std::numbers::ln2 / std::numbers::pi, tau / 3.0,
          tau * tau / 2.0};
}

/// The curve as it is fitted: shortest tau first.
struct Curve {
  ArrayXd variance;       // of the deviations
  ArrayXd chance;         // u^2
  Eigen::MatrixXd terms;  // unit_variances()

  Curve from(Index start) const {
    const Index count = variance.size() - start;
    return {variance.tail(count), chance.tail(count), terms.bottomRows(count)};
  }
};

struct TermFit {
  double cost = std::numeric_limits<double>::infinity();
  Index start = 0;
  double misfit = 0.0;                            // f^2
  ArrayXd squares = ArrayXd::Zero(kTerms);        // of coefficients, signed Q
  ArrayXd uncertainties = ArrayXd::Zero(kTerms);  // 1-sigma, of the squares
};

/// The f^2 that makes r most likely: sum (r^2 - u^2 - f^2)/(u^2 + f^2)^2 = 0.
double likely_misfit(const ArrayXd& residual, const ArrayXd& chance) {
  const auto slope = [&](double misfit) {
    const ArrayXd all = chance + misfit;
    return ((residual.square() - all) / all.square()).sum();
  };
  double low = 0.0, high = residual.square().maxCoeff();
  if (!(high > 0.0) || slope(low) <= 0.0) return 0.0;
  while (high - low > kSettled * high) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Fits the terms of `used` to a curve, alternating with the misfit. Returns
/// nothing if a square other than that of Q is below zero, or a sum of terms is
/// not above zero.
std::optional<TermFit> fit_terms(const Curve& curve,
                                 const std::vector<int>& used) {
  const Eigen::MatrixXd terms = curve.terms(Eigen::all, used);
  TermFit fit;
  Eigen::VectorXd found;
  ArrayXd model = curve.variance, residual;
  Eigen::MatrixXd weighted;
  Eigen::VectorXd scale;
  for (int round = 0; round < kMostRounds; ++round) {
    const ArrayXd weight = 0.5 * (curve.chance + fit.misfit).rsqrt() / model;
    weighted = weight.matrix().asDiagonal() * terms;
    scale = weighted.colwise().norm().transpose();
    weighted = weighted * scale.cwiseInverse().asDiagonal();
    found = weighted.colPivHouseholderQr()
                .solve((weight * curve.variance).matrix())
                .cwiseQuotient(scale);
    const ArrayXd next = (terms * found).array();
    if (!(next > 0.0).all()) {
      if (round > 3) return std::nullopt;
      model = next.max(0.1 * curve.variance);
      continue;
    }
    const double change = (next / model - 1.0).abs().maxCoeff();
    model = next;
    residual = 0.5 * (curve.variance / model).log();
    const double before = fit.misfit;
    fit.misfit = likely_misfit(residual, curve.chance);
    if (round > 0 && change < kSettled &&
        std::abs(fit.misfit - before) <= kSettled * fit.misfit)
      break;
  }
  if (residual.size() == 0) return std::nullopt;
  const Eigen::MatrixXd covariance =
      (weighted.transpose() * weighted).inverse();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (found(k) <= 0.0 && used[i] != kQuantisation) return std::nullopt;
    fit.squares(used[i]) = found(k);
    fit.uncertainties(used[i]) = std::sqrt(covariance(k, k)) / scale(k);
  }
  // Only white noise has a band to limit.
  if (fit.squares(kQuantisation) < 0.0 && !(fit.squares(kAngleWalk) > 0.0))
    return std::nullopt;
  const ArrayXd all = curve.chance + fit.misfit;
  fit.cost = (residual.square() / all + all.log()).sum() +
             kPrice * static_cast<double>(used.size());
  return fit;
}

std::vector<int> terms_of(int subset) {
  std::vector<int> used;
  for (int term = 0; term < kTerms; ++term)
    if ((subset >> term & 1) != 0) used.push_back(term);
  return used;
}

/// All sets of terms from all starts: five terms have 31 sets.
TermFit best_fit(const Curve& curve) {
  TermFit best;
  const Index points = curve.variance.size();
  const Index last =
      std::min(points / 2, points - static_cast<Index>(kLeastPoints));
  for (Index start = 0; start <= last; ++start) {
    const Curve used = curve.from(start);
    for (int subset = 1; subset < 1 << kTerms; ++subset) {
      const std::vector<int> terms = terms_of(subset);
      if (points - start < static_cast<Index>(terms.size()) + kLeastFreedom)
        continue;
      std::optional<TermFit> fit = fit_terms(used, terms);
      if (!fit) continue;
      fit->cost += (curve.chance.head(start) + fit->misfit).log().sum() +
                   kPrice * static_cast<double>(start);
      fit->start = start;
      if (fit->cost < best.cost) best = *fit;
    }
  }
  return best;
}

bool is_usable(const AllanPoint& point) {
  return point.deviation > 0.0 && point.clusters > 1 &&
         relative_uncertainty(point) <= kMostUncertain;
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
        "Allan curve: {} points with an uncertainty of {:g} % or less, must be "
        "at least {}",
        used.size(), 100.0 * kMostUncertain, kLeastPoints));
  }
  std::ranges::sort(used, {}, &AllanPoint::tau);
  return used;
}

Curve curve_of(const std::vector<AllanPoint>& used) {
  const auto rows = static_cast<Index>(used.size());
  Curve curve{ArrayXd(rows), ArrayXd(rows), Eigen::MatrixXd(rows, kTerms)};
  for (Index i = 0; i < rows; ++i) {
    const AllanPoint& point = used[static_cast<std::size_t>(i)];
    curve.variance(i) = point.deviation * point.deviation;
    curve.chance(i) = std::pow(relative_uncertainty(point), 2);
    const auto units = unit_variances(point.tau);
    for (int term = 0; term < kTerms; ++term)
      curve.terms(i, term) = units[static_cast<std::size_t>(term)];
  }
  return curve;
}

std::optional<CoefficientEstimate> estimate(const TermFit& fit, Term term) {
  const double square = fit.squares(term);
  if (!(square > 0.0)) return std::nullopt;
  const double value = std::sqrt(square);
  return CoefficientEstimate{value, fit.uncertainties(term) / (2.0 * value)};
}

nlohmann::ordered_json report_json(const CoefficientReport& report) {
  if (!report.per_second) return nullptr;
  const double value = report.per_second->value;
  return {{"per_second", {{"value", value}, {"unit", report.unit_per_second}}},
          {"per_hour",
           {{"value", value * report.hours_per_second_unit},
            {"unit", report.unit_per_hour}}},
          {"relative_uncertainty", report.per_second->uncertainty / value}};
}

}  // namespace

bool has_noise_coefficients(const std::vector<AllanPoint>& points) {
  return std::ranges::count_if(points, is_usable) >=
         static_cast<std::ptrdiff_t>(kLeastPoints);
}

NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points) {
  const std::vector<AllanPoint> used = usable(points);
  const Curve curve = curve_of(used);
  const TermFit fit = best_fit(curve);
  NoiseCoefficients result;
  result.angle_quantisation = estimate(fit, kQuantisation);
  result.angle_random_walk = estimate(fit, kAngleWalk);
  result.bias_instability = estimate(fit, kFlicker);
  result.rate_random_walk = estimate(fit, kRateWalk);
  result.rate_ramp = estimate(fit, kRamp);
  if (fit.squares(kQuantisation) < 0.0)
    result.band_limit =
        -2.0 * fit.squares(kQuantisation) / fit.squares(kAngleWalk);
  result.lowest = *std::ranges::min_element(used, {}, &AllanPoint::deviation);
  result.still_falling = result.lowest.tau == used.back().tau;
  result.misfit = std::sqrt(fit.misfit);
  const ArrayXd model = (curve.terms * fit.squares.matrix()).array();
  for (Index i = 0; i < curve.variance.size(); ++i) {
    const double tau = used[static_cast<std::size_t>(i)].tau;
    if (i >= fit.start)
      result.taus.push_back(tau);
    else
      result.left_out.push_back({tau, std::sqrt(curve.variance(i) / model(i))});
  }
  return result;
}

std::vector<CoefficientReport> reports(const NoiseCoefficients& c,
                                       const std::string& unit) {
  if (unit == "deg/s")
    return {
        {'Q', "angle quantisation", c.angle_quantisation, 1.0, "deg", "deg"},
        {'N', "angle random walk", c.angle_random_walk, 60.0, "deg/sqrt(s)",
         "deg/sqrt(h)"},
        {'B', "bias instability", c.bias_instability, 3600.0, "deg/s", "deg/h"},
        {'K', "rate random walk", c.rate_random_walk, 3600.0 * 60.0,
         "deg/s/sqrt(s)", "deg/h/sqrt(h)"},
        {'R', "rate ramp", c.rate_ramp, 3600.0 * 3600.0, "deg/s/s", "deg/h/h"}};
  const auto times = [&](const char* factor) { return unit + factor; };
  return {{'Q', "quantisation", c.angle_quantisation, 1.0 / 3600.0, times(" s"),
           times(" h")},
          {'N', "white noise", c.angle_random_walk, 1.0 / 60.0,
           times(" sqrt(s)"), times(" sqrt(h)")},
          {'B', "flicker", c.bias_instability, 1.0, unit, unit},
          {'K', "random walk", c.rate_random_walk, 60.0, times("/sqrt(s)"),
           times("/sqrt(h)")},
          {'R', "ramp", c.rate_ramp, 3600.0, times("/s"), times("/h")}};
}

nlohmann::ordered_json to_json(const NoiseCoefficients& coefficients,
                               const std::string& unit) {
  nlohmann::ordered_json json;
  for (const CoefficientReport& report : reports(coefficients, unit))
    json[std::string(1, report.symbol)] = report_json(report);
  json["lowest"] = {{"tau_s", coefficients.lowest.tau},
                    {"deviation", coefficients.lowest.deviation},
                    {"still_falling", coefficients.still_falling}};
  auto left_out = nlohmann::ordered_json::array();
  for (const LeftOutTau& tau : coefficients.left_out)
    left_out.push_back({{"tau_s", tau.tau}, {"deviation_over_fit", tau.ratio}});
  json["fit"] = {
      {"taus_s", coefficients.taus},
      {"left_out", left_out},
      {"misfit", coefficients.misfit},
      {"band_limit_s", coefficients.band_limit
                           ? nlohmann::ordered_json(*coefficients.band_limit)
                           : nullptr}};
  return json;
}

}  // namespace beamgyro
