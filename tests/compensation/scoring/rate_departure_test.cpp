// SPDX-License-Identifier: MIT
#include "compensation/scoring/rate_departure.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>

#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::rate_departure_test {
namespace {

struct Samples {
  std::vector<double> time;           // [s]
  Eigen::VectorXd rate, temperature;  // about their means
};

// A rate that swings and steps while the temperature creeps.
Samples samples_over(double duration, double step) {
  Samples s;
  const auto count = static_cast<Eigen::Index>(duration / step) + 1;
  s.rate.resize(count);
  s.temperature.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * step;
    s.time.push_back(t);
    s.rate(k) = std::sin(t / 70) + (std::fmod(t, 900) < 400 ? 1.0 : -1.0);
    s.temperature(k) = 0.1 * std::sin(t / 900) + t / duration;
  }
  s.rate.array() -= s.rate.mean();
  s.temperature.array() -= s.temperature.mean();
  return s;
}

// The damped least-squares problem of the header, every hat a dense column.
Eigen::VectorXd dense_without_drift(const Samples& s) {
  const double duration = s.time.back() - s.time.front();
  const auto pieces = std::max<Eigen::Index>(
      1, static_cast<Eigen::Index>(std::ceil(duration / kDriftKnots)));
  const double piece = duration / static_cast<double>(pieces);
  const Eigen::Index n = s.rate.size();
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(n, pieces + 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = s.time[static_cast<std::size_t>(k)] - s.time.front();
    for (Eigen::Index j = 0; j <= pieces; ++j) {
      terms(k, j) =
          std::max(0.0, 1 - std::abs(t / piece - static_cast<double>(j)));
    }
  }
  terms.col(pieces + 1) = s.temperature / s.temperature.cwiseAbs().maxCoeff();
  Eigen::MatrixXd normal = terms.transpose() * terms;
  normal.diagonal().array() += kDriftDamping * static_cast<double>(n);
  const Eigen::VectorXd heights =
      reference::solution(normal, terms.transpose() * s.rate);
  return s.rate - terms * heights;
}

TEST(RateDeparture, WithoutDriftIsTheDampedLeastSquaresOfItsDefinition) {
  for (const double duration : {120.0, 290.0, 1000.0, 20000.0}) {
    const Samples s = samples_over(duration, 7);
    // The damping bounds the condition by 1e6: 1e-16 x 1e6, with a margin.
    EXPECT_LT(
        (without_drift(s.rate, s.temperature, s.time) - dense_without_drift(s))
            .cwiseAbs()
            .maxCoeff(),
        1e-9)
        << duration;
  }
}

// Least processor time of five tries [s].
double cost(const Samples& s) {
  double least = 1e9;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    const double sum = without_drift(s.rate, s.temperature, s.time).sum();
    EXPECT_TRUE(std::isfinite(sum));
    least = std::min(
        least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(RateDeparture, CostGrowsNoFasterThanTheLengthOfThePlateau) {
  // 1.7 and 7 days at ten samples a piece. Four times the length costs four
  // times as much where the work is linear, 64 times where a dense matrix of
  // the pieces is solved; twice four leaves room for caches.
  const double one = cost(samples_over(150'000, 30));
  const double four = cost(samples_over(600'000, 30));
  EXPECT_LT(four, 8 * one + 1e-4);
}

}  // namespace
}  // namespace beamgyro::internal::rate_departure_test
