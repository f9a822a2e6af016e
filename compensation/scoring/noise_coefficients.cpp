// SPDX-License-Identifier: MIT
#include "compensation/scoring/noise_coefficients.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "compensation/scoring/difference_covariance.h"
#include "config/range.h"
#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/least_squares.h"
#include "linear_algebra/linear_systems.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kMostUncertain = 0.25;  // [-]
constexpr std::size_t kLeastPoints = 5;
constexpr Index kLeastFreedom = 2;  // points more than terms
constexpr double kPrice = 9.0;      // of a term or of a tau: 3 standard errors
constexpr int kMostRounds = 50;
constexpr double kSettled = 1e-9;        // [-]
constexpr double kUncertainPrice = 5.0;  // 2.2 standard errors
constexpr double kLeastLikely = 12.0;    // of costs: 1/400 of the best
constexpr int kMostPasses = 3;
constexpr double kLeastChance = 1e-14;  // [-], of rounding: 1e-7 of a deviation
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
  ArrayXd variance;        // of the deviations
  Eigen::MatrixXd terms;   // unit_variances()
  Eigen::MatrixXd chance;  // covariance of the logarithms of deviations

  Curve from(Index start) const {
    const Index count = variance.size() - start;
    return {variance.tail(count), terms.bottomRows(count),
            chance.bottomRightCorner(count, count)};
  }
};

/// Sums of deviations that do not depend on each other, by chance.
struct Independent {
  explicit Independent(const Eigen::MatrixXd& chance) {
    const SymmetricEigen parts = symmetric_eigen(chance);
    sums = parts.vectors.transpose();
    chances = parts.values.array().max(kLeastChance);
  }
  Eigen::MatrixXd sums;  // a row each
  ArrayXd chances;       // their variances
};

struct TermFit {
  double cost = std::numeric_limits<double>::infinity();
  Index start = 0;
  double misfit = 0.0;                      // f^2
  ArrayXd squares = ArrayXd::Zero(kTerms);  // of coefficients, signed Q
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

/// Returns what makes the differences of squared deviations from `model`
/// independent and of variance one.
Eigen::MatrixXd weights(const Independent& independent, double misfit,
                        const ArrayXd& model) {
  return (0.5 * (independent.chances + misfit).rsqrt()).matrix().asDiagonal() *
         independent.sums * model.inverse().matrix().asDiagonal();
}

/// Fits the terms of `used` to a curve, alternating with the misfit. Returns
/// nothing if a square other than that of Q is below zero, or a sum of terms is
/// not above zero.
std::optional<TermFit> fit_terms(const Curve& curve,
                                 const Independent& independent,
                                 const std::vector<int>& used) {
  const Eigen::MatrixXd terms = curve.terms(Eigen::all, used);
  TermFit fit;
  Eigen::VectorXd found;
  ArrayXd model = curve.variance, residual;
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::MatrixXd weight = weights(independent, fit.misfit, model);
    const Eigen::MatrixXd weighted = weight * terms;
    const Eigen::VectorXd scale = weighted.colwise().norm().transpose();
    found = least_squares(weighted * scale.cwiseInverse().asDiagonal(),
                          weight * curve.variance.matrix())
                .x.cwiseQuotient(scale);
    const ArrayXd next = (terms * found).array();
    if (!(next > 0.0).all()) {
      if (round > 3) return std::nullopt;
      model = next.max(0.1 * curve.variance);
      continue;
    }
    const double change = (next / model - 1.0).abs().maxCoeff();
    model = next;
    residual =
        (independent.sums * (0.5 * (curve.variance / model).log()).matrix())
            .array();
    const double before = fit.misfit;
    fit.misfit = likely_misfit(residual, independent.chances);
    if (round > 0 && change < kSettled &&
        std::abs(fit.misfit - before) <= kSettled * fit.misfit)
      break;
  }
  if (residual.size() == 0) return std::nullopt;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double square = found(static_cast<Index>(i));
    if (square <= 0.0 && used[i] != kQuantisation) return std::nullopt;
    fit.squares(used[i]) = square;
  }
  // Only white noise has a band to limit.
  if (fit.squares(kQuantisation) < 0.0 && !(fit.squares(kAngleWalk) > 0.0))
    return std::nullopt;
  fit.cost = (residual.square() / (independent.chances + fit.misfit)).sum() +
             kPrice * static_cast<double>(used.size());
  return fit;
}

std::vector<int> terms_of(int subset) {
  std::vector<int> used;
  for (int term = 0; term < kTerms; ++term)
    if ((subset >> term & 1) != 0) used.push_back(term);
  return used;
}

/// Fits all sets of terms from all starts: five terms have 31 sets.
std::vector<TermFit> all_fits(const Curve& curve) {
  std::vector<TermFit> fits;
  const Index points = curve.variance.size();
  const Index last =
      std::min(points / 2, points - static_cast<Index>(kLeastPoints));
  const ArrayXd chances = Independent(curve.chance).chances;
  for (Index start = 0; start <= last; ++start) {
    const Curve used = curve.from(start);
    const Independent independent(used.chance);
    for (int subset = 1; subset < 1 << kTerms; ++subset) {
      const std::vector<int> terms = terms_of(subset);
      if (points - start < static_cast<Index>(terms.size()) + kLeastFreedom)
        continue;
      std::optional<TermFit> fit = fit_terms(used, independent, terms);
      if (!fit) continue;
      // A tau that is left out has a term of its own.
      fit->cost += (chances + fit->misfit).log().sum() +
                   kPrice * static_cast<double>(start);
      fit->start = start;
      fits.push_back(*fit);
    }
  }
  return fits;
}

TermFit best_of(const std::vector<TermFit>& fits) {
  return *std::ranges::min_element(fits, {}, &TermFit::cost);
}

// Fourth powers of both stay numbers.
constexpr Range kUsableDeviations{1e-60, 1e60}, kUsableTaus{1e-60, 1e60};

bool is_usable(const AllanPoint& point) {
  return kUsableDeviations.contains(point.deviation) &&
         kUsableTaus.contains(point.tau) && point.clusters > 1 &&
         relative_uncertainty(point) <= kMostUncertain;
}

std::vector<AllanPoint> usable(const std::vector<AllanPoint>& points) {
  std::vector<AllanPoint> used;
  for (const AllanPoint& point : points) {
    if (!std::isfinite(point.deviation))
      throw std::invalid_argument(fmt::format(
          "deviation at {} s: {}, must be finite", point.tau, point.deviation));
    if (is_usable(point)) used.push_back(point);
  }
  if (used.size() < kLeastPoints)
    throw std::invalid_argument(fmt::format(
        "Allan curve: {} points with an uncertainty of {:g} % or less, must be "
        "at least {}",
        used.size(), 100.0 * kMostUncertain, kLeastPoints));
  std::ranges::sort(used, {}, &AllanPoint::tau);
  return used;
}

Curve curve_of(const std::vector<AllanPoint>& used) {
  const auto rows = static_cast<Index>(used.size());
  Curve curve{ArrayXd(rows), Eigen::MatrixXd(rows, kTerms),
              Eigen::MatrixXd::Zero(rows, rows)};
  for (Index i = 0; i < rows; ++i) {
    const AllanPoint& point = used[static_cast<std::size_t>(i)];
    curve.variance(i) = point.deviation * point.deviation;
    curve.chance(i, i) = std::pow(relative_uncertainty(point), 2);
    const auto units = unit_variances(point.tau);
    for (int term = 0; term < kTerms; ++term)
      curve.terms(i, term) = units[static_cast<std::size_t>(term)];
  }
  return curve;
}

/// Generalised autocovariance of the angles of noise with these squares of
/// coefficients, at t samples of `interval` (difference_covariance.h).
std::function<double(double)> autocovariance(const ArrayXd& squares,
                                             double interval) {
  return [=](double t) {
    const double lag = std::abs(t) * interval;
    if (lag == 0.0) return squares(kQuantisation);
    return lag *
           (-0.5 * squares(kAngleWalk) +
            lag * (0.5 / std::numbers::pi * squares(kFlicker) * std::log(lag) +
                   lag * squares(kRateWalk) / 12.0));
  };
}

/// Covariances of the logarithms of deviations by chance, in noise with these
/// squares of coefficients.
Eigen::MatrixXd chance_covariance(const std::vector<AllanPoint>& points,
                                  const Eigen::MatrixXd& terms,
                                  ArrayXd squares) {
  squares = squares.max(0.0);
  const double interval = points.front().tau;
  const auto r = autocovariance(squares, interval);
  const auto differences = [&](const AllanPoint& point) {
    const double m = std::round(point.tau / interval);
    return AngleDifferences{
        2, m, (static_cast<double>(point.clusters) - 2.0) * m + 1.0};
  };
  const auto count = static_cast<Index>(points.size());
  Eigen::MatrixXd covariance(count, count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j <= i; ++j) {
      const AllanPoint& one = points[static_cast<std::size_t>(i)];
      const AllanPoint& other = points[static_cast<std::size_t>(j)];
      const PairMeans found =
          pair_means(r, differences(one), differences(other));
      // A ramp is a mean R tau of each difference.
      const double taus = one.tau * other.tau;
      covariance(i, j) = covariance(j, i) =
          one.gap_noise * other.gap_noise *
          (0.5 * found.squares / (taus * taus) +
           squares(kRamp) * found.covariance);
    }
  const auto scale = (0.5 / (terms * squares.matrix()).array()).matrix();
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

/// Variances of the squares of the coefficients of a fit.
ArrayXd variances_of(const Curve& curve, const TermFit& fit) {
  std::vector<int> terms;
  for (int term = 0; term < kTerms; ++term)
    if (fit.squares(term) != 0.0) terms.push_back(term);
  const Curve fitted = curve.from(fit.start);
  const ArrayXd model = (fitted.terms * fit.squares.matrix()).array();
  const Eigen::MatrixXd weighted =
      weights(Independent(fitted.chance), fit.misfit, model) *
      fitted.terms(Eigen::all, terms);
  const Eigen::VectorXd scale = weighted.colwise().norm().transpose();
  const Eigen::MatrixXd scaled = weighted * scale.cwiseInverse().asDiagonal();
  ArrayXd all = ArrayXd::Zero(kTerms);
  const Eigen::MatrixXd normal = scaled.transpose() * scaled;
  all(terms) = inverse_of(normal).diagonal().array() / scale.array().square();
  return all;
}

/// -2 ln of the likelihood of a fit, with a lower price of its terms: what the
/// best fit leaves out, since it is not sure, makes the rest uncertain.
double uncertain_cost(const TermFit& fit) {
  const auto terms = static_cast<double>((fit.squares != 0.0).count());
  return fit.cost -
         (kPrice - kUncertainPrice) * (terms + static_cast<double>(fit.start));
}

/// Standard deviations of the squares of the coefficients of the best fit: of
/// all fits with the term, as likely as they are, about the best.
ArrayXd uncertainties(const Curve& curve, const std::vector<TermFit>& fits,
                      const TermFit& best) {
  double least = uncertain_cost(best);
  for (const TermFit& fit : fits) least = std::min(least, uncertain_cost(fit));
  ArrayXd sums = ArrayXd::Zero(kTerms), all = sums;
  for (const TermFit& fit : fits) {
    const double cost = uncertain_cost(fit) - least;
    if (cost > kLeastLikely && fit.cost > best.cost) continue;
    const ArrayXd likelihood =
        (fit.squares > 0.0).cast<double>() * std::exp(-0.5 * cost);
    sums += likelihood *
            (variances_of(curve, fit) + (fit.squares - best.squares).square());
    all += likelihood;
  }
  return (sums / all.max(std::numeric_limits<double>::min())).sqrt();
}

/// Fits with the chances of independent deviations, then with those of noise of
/// the terms found, which `curve` has at the end.
std::vector<TermFit> settled_fits(const std::vector<AllanPoint>& used,
                                  Curve& curve) {
  std::vector<TermFit> fits = all_fits(curve);
  for (int pass = 1; pass < kMostPasses; ++pass) {
    const TermFit before = best_of(fits);
    curve.chance = chance_covariance(used, curve.terms, before.squares);
    fits = all_fits(curve);
    const TermFit fit = best_of(fits);
    if (fit.start == before.start &&
        ((fit.squares != 0.0) == (before.squares != 0.0)).all())
      break;
  }
  return fits;
}

std::optional<CoefficientEstimate> estimate(double square, double uncertainty) {
  if (!(square > 0.0)) return std::nullopt;
  const double value = std::sqrt(square);
  return CoefficientEstimate{
      value, uncertainty / (2.0 * value),
      confidence_interval(value, 2.0 * std::pow(square / uncertainty, 2))};
}

}  // namespace

bool has_noise_coefficients(const std::vector<AllanPoint>& points) {
  return std::ranges::count_if(points, is_usable) >=
         static_cast<std::ptrdiff_t>(kLeastPoints);
}

NoiseCoefficients noise_coefficients(const std::vector<AllanPoint>& points) {
  const std::vector<AllanPoint> used = usable(points);
  Curve curve = curve_of(used);
  const std::vector<TermFit> fits = settled_fits(used, curve);
  const TermFit fit = best_of(fits);
  NoiseCoefficients result;
  const ArrayXd uncertain = uncertainties(curve, fits, fit);
  const auto of = [&](Term term) {
    return estimate(fit.squares(term), uncertain(term));
  };
  result.angle_quantisation = of(kQuantisation);
  result.angle_random_walk = of(kAngleWalk);
  result.bias_instability = of(kFlicker);
  result.rate_random_walk = of(kRateWalk);
  result.rate_ramp = of(kRamp);
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

}  // namespace beamgyro::internal
