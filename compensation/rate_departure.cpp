// SPDX-License-Identifier: MIT
#include "compensation/rate_departure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace beamgyro {
namespace {

/// Divided by its largest value, unless that is zero.
Eigen::VectorXd to_unit(const Eigen::VectorXd& values) {
  const double largest = values.cwiseAbs().maxCoeff();
  return largest > 0.0 ? Eigen::VectorXd(values / largest) : values;
}

/// The three terms of a sample that are not zero: hats `left` and `left` + 1,
/// and the temperature, the last of all terms.
struct Terms {
  std::array<Eigen::Index, 3> index;
  std::array<double, 3> value;
};

std::vector<Terms> drift_terms(const std::vector<double>& time,
                               const Eigen::VectorXd& temperature,
                               Eigen::Index pieces) {
  const double piece =
      (time.back() - time.front()) / static_cast<double>(pieces);
  std::vector<Terms> all;
  all.reserve(time.size());
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double knots = piece > 0.0 ? (time[k] - time.front()) / piece : 0.0;
    const auto left =
        std::min(static_cast<Eigen::Index>(std::floor(knots)), pieces - 1);
    const double right_share = knots - static_cast<double>(left);
    all.push_back({{left, left + 1, pieces + 1},
                   {1.0 - right_share, right_share,
                    temperature(static_cast<Eigen::Index>(k))}});
  }
  return all;
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
  const auto terms = drift_terms(time, to_unit(temperature), pieces);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(pieces + 2, pieces + 2);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(pieces + 2);
  for (Eigen::Index k = 0; k < rate.size(); ++k) {
    const auto& [index, value] = terms[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < index.size(); ++i) {
      right(index[i]) += value[i] * rate(k);
      for (std::size_t j = 0; j < index.size(); ++j) {
        normal(index[i], index[j]) += value[i] * value[j];
      }
    }
  }
  normal.diagonal().array() += kDriftDamping * static_cast<double>(rate.size());
  const Eigen::VectorXd found = normal.ldlt().solve(right);
  Eigen::VectorXd left_over = rate;
  for (Eigen::Index k = 0; k < rate.size(); ++k) {
    const auto& [index, value] = terms[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < index.size(); ++i) {
      left_over(k) -= value[i] * found(index[i]);
    }
  }
  return left_over;
}

}  // namespace beamgyro
