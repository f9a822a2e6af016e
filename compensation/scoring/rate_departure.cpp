// SPDX-License-Identifier: MIT
#include "compensation/scoring/rate_departure.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beamgyro::internal {
namespace {

/// Divided by its largest value, unless that is zero.
Eigen::VectorXd to_unit(const Eigen::VectorXd& values) {
  const double largest = values.cwiseAbs().maxCoeff();
  return largest > 0.0 ? Eigen::VectorXd(values / largest) : values;
}

/// The hats of a sample that are not zero: `left` and the next one.
struct Hats {
  Eigen::Index left;
  double share_left, share_right;
};

std::vector<Hats> drift_hats(const std::vector<double>& time,
                             Eigen::Index pieces) {
  const double piece =
      (time.back() - time.front()) / static_cast<double>(pieces);
  std::vector<Hats> all;
  all.reserve(time.size());
  for (const double t : time) {
    const double knots = piece > 0.0 ? (t - time.front()) / piece : 0.0;
    const auto left =
        std::min(static_cast<Eigen::Index>(std::floor(knots)), pieces - 1);
    const double right_share = knots - static_cast<double>(left);
    all.push_back({left, 1.0 - right_share, right_share});
  }
  return all;
}

/// Normal equations A p = b of the hats and of one term over all samples: hats
/// meet their neighbours only, so that A is tridiagonal but for its last row
/// and column.
struct NormalEquations {
  Eigen::VectorXd diagonal;  // A(j, j) of the hats
  Eigen::VectorXd next;      // A(j, j + 1) of the hats, unused past the end
  Eigen::VectorXd last;      // A(j, last)
  Eigen::VectorXd right;     // b of the hats
  double last_diagonal = 0.0, last_right = 0.0;

  explicit NormalEquations(Eigen::Index hats)
      : diagonal(Eigen::VectorXd::Zero(hats)),
        next(Eigen::VectorXd::Zero(hats)),
        last(Eigen::VectorXd::Zero(hats)),
        right(Eigen::VectorXd::Zero(hats)) {}

  void add(const Hats& hats, double term, double value) {
    const auto [j, left, right_share] = hats;
    diagonal(j) += left * left;
    diagonal(j + 1) += right_share * right_share;
    next(j) += left * right_share;
    last(j) += left * term;
    last(j + 1) += right_share * term;
    last_diagonal += term * term;
    right(j) += left * value;
    right(j + 1) += right_share * value;
    last_right += term * value;
  }

  void damp(double damping) {
    diagonal.array() += damping;
    last_diagonal += damping;
  }
};

struct Drift {
  Eigen::VectorXd knots;  // p_j
  double term;            // of the term over all samples
};

/// Gaussian elimination from the first hat on, which fills nothing in. A is
/// positive definite once it is damped, so that no pivots are sought.
Drift solved(NormalEquations A) {
  const Eigen::Index hats = A.diagonal.size();
  for (Eigen::Index j = 0; j < hats; ++j) {
    if (j + 1 < hats) {
      const double factor = A.next(j) / A.diagonal(j);
      A.diagonal(j + 1) -= factor * A.next(j);
      A.last(j + 1) -= factor * A.last(j);
      A.right(j + 1) -= factor * A.right(j);
    }
    const double factor = A.last(j) / A.diagonal(j);
    A.last_diagonal -= factor * A.last(j);
    A.last_right -= factor * A.right(j);
  }
  Drift drift{Eigen::VectorXd(hats), A.last_right / A.last_diagonal};
  for (Eigen::Index j = hats; j-- > 0;) {
    const double after = j + 1 < hats ? A.next(j) * drift.knots(j + 1) : 0.0;
    drift.knots(j) =
        (A.right(j) - after - A.last(j) * drift.term) / A.diagonal(j);
  }
  return drift;
}

}  // namespace

Eigen::VectorXd without_temperature(const Eigen::VectorXd& rate,
                                    const Eigen::VectorXd& temperature) {
  const Eigen::VectorXd term = to_unit(temperature);
  const double damping = kDriftDamping * static_cast<double>(rate.size());
  return rate - term * (term.dot(rate) / (term.squaredNorm() + damping));
}

Eigen::VectorXd without_drift(const Eigen::VectorXd& rate,
                              const Eigen::VectorXd& temperature,
                              const std::vector<double>& time) {
  const auto pieces = std::max<Eigen::Index>(
      1, static_cast<Eigen::Index>(
             std::ceil((time.back() - time.front()) / kDriftKnots)));
  const auto hats = drift_hats(time, pieces);
  const Eigen::VectorXd term = to_unit(temperature);
  NormalEquations equations(pieces + 1);
  for (Eigen::Index k = 0; k < rate.size(); ++k)
    equations.add(hats[static_cast<std::size_t>(k)], term(k), rate(k));
  equations.damp(kDriftDamping * static_cast<double>(rate.size()));
  const Drift drift = solved(std::move(equations));
  Eigen::VectorXd left_over = rate - drift.term * term;
  for (Eigen::Index k = 0; k < rate.size(); ++k) {
    const auto& [j, left, right] = hats[static_cast<std::size_t>(k)];
    left_over(k) -= left * drift.knots(j) + right * drift.knots(j + 1);
  }
  return left_over;
}

}  // namespace beamgyro::internal
