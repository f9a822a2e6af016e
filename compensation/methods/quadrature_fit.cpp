// SPDX-License-Identifier: MIT
#include "compensation/methods/quadrature_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "linear_algebra/cholesky.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPlacesBeyond = 1.0;  // scaled, of places beyond the range
constexpr Index kGridPlaces = 100, kGridWidths = 9;
constexpr int kIterations = 25, kTrials = 6, kPatience = 2;
constexpr double kLargestShare = 1.5;
constexpr double kUsualHeight = 2.0;  // scaled
constexpr double kRidge = 1e-10;      // of the linear part, relative

// -u / (1 + u^2) and its slope in u.
ArrayXd twin(const ArrayXd& u) { return -u / (1.0 + u.square()); }
ArrayXd twin_slope(const ArrayXd& u) {
  return -(1.0 - u.square()) / (1.0 + u.square()).square();
}

// What the search varies: shares, then place and ln width of each resonance.
struct Search {
  VectorXd shares;
  std::vector<std::pair<double, double>> resonances;

  VectorXd packed() const {
    VectorXd all(shares.size() + 2 * static_cast<Index>(resonances.size()));
    all.head(shares.size()) = shares;
    Index at = shares.size();
    for (const auto& [place, log_width] : resonances) {
      all(at++) = place;
      all(at++) = log_width;
    }
    return all;
  }
};

class Problem {
 public:
  Problem(const VectorXd& T, const MatrixXd& z, const VectorXd& q,
          const QuadratureFitOptions& options)
      : T_(T), z_(z), q_(q), options_(options) {}

  // The linear part solved for one search, and what is left.
  struct Solved {
    Search search;
    ArrayXd t;
    MatrixXd columns;  // powers, then twins
    MatrixXd inverse;  // of columns^T columns
    VectorXd factors, residual;
    double squares = 0.0;
  };

  Solved solve(Search search) const {
    Solved s{std::move(search), {}, {}, {}, {}, {}, 0.0};
    s.t = (T_ + z_ * s.search.shares).array();
    const Index powers = options_.degree + 1;
    s.columns.resize(T_.size(),
                     powers + static_cast<Index>(s.search.resonances.size()));
    s.columns.col(0).setOnes();
    for (Index n = 1; n < powers; ++n)
      s.columns.col(n) = s.columns.col(n - 1).array() * s.t;
    Index at = powers;
    for (const auto& [place, log_width] : s.search.resonances)
      s.columns.col(at++) = twin(2.0 * std::exp(-log_width) * (s.t - place));
    MatrixXd normal = s.columns.transpose() * s.columns;
    normal.diagonal() *= 1.0 + kRidge;
    normal.diagonal().tail(normal.cols() - powers).array() +=
        variance() / (kUsualHeight * kUsualHeight);
    s.inverse = Cholesky(normal).inverse();
    s.factors = s.inverse * (s.columns.transpose() * q_);
    s.residual = q_ - s.columns * s.factors;
    s.squares = s.residual.squaredNorm();
    return s;
  }

  // What is left of other columns beside those of the linear part.
  static MatrixXd without(const Solved& s, const MatrixXd& others) {
    return others - s.columns * (s.inverse * (s.columns.transpose() * others));
  }

  Search with_another(const Solved& s) const;
  Solved refined(Solved s) const;
  Solved pruned(Solved s) const;

  double evidence(const Solved& s) const {
    const auto n = static_cast<double>(q_.size());
    const double parameters =
        3.0 * static_cast<double>(s.search.resonances.size());
    return n * std::log(std::max(s.squares / n, variance())) +
           parameters * std::log(n) + unlikely_heights(s);
  }

 private:
  double variance() const { return options_.noise * options_.noise; }
  double unlikely_heights(const Solved& s) const {
    const Index powers = options_.degree + 1;
    return s.factors.tail(s.factors.size() - powers).squaredNorm() /
           (kUsualHeight * kUsualHeight);
  }
  MatrixXd jacobian(const Solved& s) const;
  Search stepped(const Search& from, const VectorXd& step) const;

  const VectorXd& T_;
  const MatrixXd& z_;
  const VectorXd& q_;
  const QuadratureFitOptions& options_;
};

// Adds the resonance of a grid that takes away most of the squares.
Search Problem::with_another(const Solved& s) const {
  const double low = std::log(options_.narrowest);
  const double high = std::log(options_.widest);
  double most = -1.0;
  std::pair<double, double> best;
  for (Index w = 0; w < kGridWidths; ++w) {
    const double log_width = low + (high - low) * static_cast<double>(w) /
                                       static_cast<double>(kGridWidths - 1);
    const VectorXd places = VectorXd::LinSpaced(
        kGridPlaces, -1.0 - kPlacesBeyond, 1.0 + kPlacesBeyond);
    MatrixXd twins(T_.size(), kGridPlaces);
    for (Index k = 0; k < kGridPlaces; ++k)
      twins.col(k) = twin(2.0 * std::exp(-log_width) * (s.t - places(k)));
    const MatrixXd left = without(s, twins);
    for (Index k = 0; k < kGridPlaces; ++k) {
      const double size = left.col(k).squaredNorm();
      if (size < 1e-3 * twins.col(k).squaredNorm()) continue;
      const double overlap = left.col(k).dot(s.residual);
      if (overlap * overlap > most * size) {
        most = overlap * overlap / size;
        best = {places(k), log_width};
      }
    }
  }
  Search search = s.search;
  search.resonances.push_back(best);
  return search;
}

MatrixXd Problem::jacobian(const Solved& s) const {
  const Index shares = s.search.shares.size(), powers = options_.degree + 1;
  ArrayXd slope = ArrayXd::Zero(T_.size());  // dq/dt
  for (Index n = 1; n < powers; ++n)
    slope +=
        static_cast<double>(n) * s.factors(n) * s.columns.col(n - 1).array();
  MatrixXd J(T_.size(),
             shares + 2 * static_cast<Index>(s.search.resonances.size()));
  Index at = shares, of = powers;
  for (const auto& [place, log_width] : s.search.resonances) {
    const double gain = 2.0 * std::exp(-log_width);
    const ArrayXd u = gain * (s.t - place);
    const ArrayXd change = s.factors(of++) * twin_slope(u);
    slope += gain * change;
    J.col(at++) = -gain * change;
    J.col(at++) = -u * change;
  }
  for (Index j = 0; j < shares; ++j) J.col(j) = slope * z_.col(j).array();
  return J;
}

Search Problem::stepped(const Search& from, const VectorXd& step) const {
  Search to = from;
  const Index shares = from.shares.size();
  to.shares = (from.shares + step.head(shares))
                  .cwiseMax(-kLargestShare)
                  .cwiseMin(kLargestShare);
  Index at = shares;
  for (auto& [place, log_width] : to.resonances) {
    place = std::clamp(place + std::clamp(step(at), -0.1, 0.1),
                       -1.0 - kPlacesBeyond, 1.0 + kPlacesBeyond);
    log_width =
        std::clamp(log_width + std::clamp(step(at + 1), -1.0, 1.0),
                   std::log(options_.narrowest), std::log(options_.widest));
    at += 2;
  }
  return to;
}

// Shares have a prior of mean 0 and sigma 1, heights one of sigma kUsualHeight,
// whose squares count with the variance of the noise.
Problem::Solved Problem::refined(Solved s) const {
  const Index shares = s.search.shares.size();
  if (s.search.packed().size() == 0) return s;
  const auto cost = [&](const Solved& any) {
    return any.squares + variance() * (any.search.shares.squaredNorm() +
                                       unlikely_heights(any));
  };
  double damping = 1e-2;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const MatrixXd J = without(s, jacobian(s));
    MatrixXd H = J.transpose() * J;
    VectorXd gradient = J.transpose() * s.residual;
    H.diagonal().head(shares).array() += variance();
    gradient.head(shares) -= variance() * s.search.shares;
    bool is_better = false;
    double gain = 0.0;
    for (int trial = 0; trial < kTrials && !is_better; ++trial) {
      MatrixXd damped = H;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-12 * H.trace() + 1e-300;
      Solved next = solve(stepped(s.search, Cholesky(damped).solve(gradient)));
      gain = cost(s) - cost(next);
      is_better = gain > 0.0;
      damping = is_better ? std::max(damping / 5.0, 1e-7) : damping * 5.0;
      if (is_better) s = std::move(next);
    }
    if (!is_better || gain < 1e-7 * cost(s)) break;
  }
  return s;
}

// Leaves out resonances one by one while that lowers the evidence: later ones
// may have made an earlier one idle.
Problem::Solved Problem::pruned(Solved s) const {
  for (bool again = true; again;) {
    again = false;
    Solved best = s;
    for (std::size_t k = 0; k < s.search.resonances.size(); ++k) {
      Search fewer = s.search;
      fewer.resonances.erase(fewer.resonances.begin() +
                             static_cast<std::ptrdiff_t>(k));
      Solved other = refined(solve(std::move(fewer)));
      if (evidence(other) < evidence(best)) {
        best = std::move(other);
        again = true;
      }
    }
    s = std::move(best);
  }
  return s;
}

// At most so many rows, evenly.
std::vector<Index> some_rows(Index all) {
  const Index step = (all + kMostQuadratureRows - 1) / kMostQuadratureRows;
  std::vector<Index> rows;
  for (Index k = 0; k < all; k += step) rows.push_back(k);
  return rows;
}

}  // namespace

QuadratureFit fit_quadrature(const VectorXd& T, const MatrixXd& z,
                             const VectorXd& q,
                             const QuadratureFitOptions& options) {
  const std::vector<Index> rows = some_rows(q.size());
  const VectorXd some_T = T(rows), some_q = q(rows);
  const MatrixXd some_z = z(rows, Eigen::all);
  const Problem problem(some_T, some_z, some_q, options);
  Problem::Solved s =
      problem.refined(problem.solve({VectorXd::Zero(z.cols()), {}}));
  Problem::Solved best = s;
  for (int count = 1, since = 0; count <= options.most && since < kPatience;
       ++count) {
    s = problem.refined(problem.solve(problem.with_another(s)));
    const bool is_better = problem.evidence(s) < problem.evidence(best);
    since = is_better ? 0 : since + 1;
    if (is_better) best = s;
  }
  best = problem.pruned(std::move(best));
  const Index powers = options.degree + 1;
  const auto count = static_cast<Index>(best.search.resonances.size());
  QuadratureFit fit{best.search.shares,
                    best.factors.head(powers),
                    VectorXd(count),
                    VectorXd(count),
                    best.factors.tail(count),
                    std::sqrt(best.squares / static_cast<double>(rows.size()))};
  for (Index k = 0; k < count; ++k) {
    const auto& [place, log_width] =
        best.search.resonances[static_cast<std::size_t>(k)];
    fit.places(k) = place;
    fit.widths(k) = std::exp(log_width);
  }
  return fit;
}

}  // namespace beamgyro::internal
