// SPDX-License-Identifier: MIT
#include "tests/linear_algebra/reference_algebra.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace beamgyro::internal::reference_algebra_test {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Rounding of a few operations on numbers about 1.
constexpr double kRounding = 1e-14;

TEST(ReferenceAlgebra, ExponentialOfANilpotentMatrixIsItsFiniteSeries) {
  const MatrixXd N{{0, 3, -7}, {0, 0, 5}, {0, 0, 0}};
  const MatrixXd expected{{1, 3, 0.5}, {0, 1, 5}, {0, 0, 1}};
  EXPECT_LT((reference::exponential(N) - expected).norm(), kRounding);
  EXPECT_EQ(reference::exponential(MatrixXd::Zero(3, 3)),
            MatrixXd::Identity(3, 3));
}

TEST(ReferenceAlgebra, ExponentialOfARotationRateIsTheRotation) {
  for (const double angle : {1e-9, 0.3, 2.0, 100.0}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const MatrixXd rate{{0, -angle}, {angle, 0}};
    const MatrixXd rotation{{c, -s}, {s, c}};
    // Each squaring doubles the error.
    EXPECT_LT((reference::exponential(rate) - rotation).norm(),
              kRounding * (1 + angle))
        << angle;
  }
}

TEST(ReferenceAlgebra, ExponentialOfADiagonalMatrixIsThatOfItsElements) {
  const std::complex<double> a(-700, 3), b(0.4, 40), c(30, -2);
  const MatrixXcd A{{a, 0, 0}, {0, b, 0}, {0, 0, c}};
  const MatrixXcd found = reference::exponential(A);
  // Each of the s squarings doubles the error of 2e-16, and 2^s < 4 |A|.
  constexpr double kDoubled = 4 * 701 * 2.2e-16;
  EXPECT_LT(std::abs(found(0, 0) / std::exp(a) - 1.0), kDoubled);
  EXPECT_LT(std::abs(found(1, 1) / std::exp(b) - 1.0), kDoubled);
  EXPECT_LT(std::abs(found(2, 2) / std::exp(c) - 1.0), kDoubled);
  EXPECT_EQ(found.cwiseAbs().sum(), found.diagonal().cwiseAbs().sum());
}

TEST(ReferenceAlgebra, SolutionsAndInverses) {
  const MatrixXd A{{0, 2, 1}, {4, -1, 3}, {1, 5, -2}};  // needs a pivot
  const MatrixXd x{{1}, {-2}, {0.5}};
  EXPECT_LT((reference::solution(A, A * x) - x).norm(), kRounding);
  EXPECT_LT((reference::inverse(A) * A - MatrixXd::Identity(3, 3)).norm(),
            kRounding);
  const std::complex<double> i(0, 1);
  const MatrixXcd C{{0, 2.0 + i}, {1.0 - 3.0 * i, i}};
  EXPECT_LT((reference::inverse(C) * C - MatrixXcd::Identity(2, 2)).norm(),
            kRounding);
}

TEST(ReferenceAlgebra, LeastSquaresLeaveAResidualNormalToTheColumns) {
  const MatrixXd A{{1, 0}, {1, 1}, {1, 2}, {1, 4}};
  const VectorXd b{{3, -1, 2, 5}};
  const VectorXd left = b - A * reference::least_squares(A, b);
  EXPECT_GT(left.norm(), 1);
  EXPECT_LT((A.transpose() * left).norm(), 10 * kRounding);
}

TEST(ReferenceAlgebra, RootsAndModesOfSymmetricMatrices) {
  const MatrixXd A{{4, 2}, {2, 5}}, M{{2, 1}, {1, 3}};
  const MatrixXd root{{2, 0}, {1, 2}};
  EXPECT_LT((reference::cholesky_root(A) - root).norm(), kRounding);
  // lambda^2 - 9 lambda + 16 = 0
  const VectorXd values = reference::symmetric_modes(A).values;
  EXPECT_NEAR(values(0), (9 - std::sqrt(17)) / 2, kRounding);
  EXPECT_NEAR(values(1), (9 + std::sqrt(17)) / 2, kRounding);
  const reference::SymmetricModes modes = reference::symmetric_modes(A, M);
  const MatrixXd& V = modes.vectors;
  EXPECT_LE(modes.values(0), modes.values(1));
  EXPECT_LT((A * V - M * V * modes.values.asDiagonal()).norm(), kRounding);
  EXPECT_LT((V.transpose() * M * V - MatrixXd::Identity(2, 2)).norm(),
            kRounding);
}

}  // namespace
}  // namespace beamgyro::internal::reference_algebra_test
