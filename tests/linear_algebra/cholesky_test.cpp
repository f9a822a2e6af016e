// SPDX-License-Identifier: MIT
#include "linear_algebra/cholesky.h"

#include <gtest/gtest.h>

namespace beamgyro::internal::cholesky_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd symmetric(double a, double b, double c) {
  MatrixXd A(2, 2);
  A << a, b, b, c;
  return A;
}

TEST(Cholesky, FactorIsTheClosedFormOfTwoRows) {
  const Cholesky cholesky(symmetric(4, 2, 10));
  EXPECT_TRUE(cholesky.is_positive_definite());
  MatrixXd L(2, 2);
  L << 2, 0, 1, 3;
  EXPECT_EQ(cholesky.lower(), L);
}

TEST(Cholesky, ReadsTheLowerTriangle) {
  MatrixXd A = symmetric(4, 2, 10);
  A(0, 1) = 1e300;
  EXPECT_EQ(Cholesky(A).lower(), Cholesky(symmetric(4, 2, 10)).lower());
}

TEST(Cholesky, SolvesForAnyNumberOfRightHandSides) {
  const Cholesky cholesky(symmetric(4, 2, 10));
  const VectorXd b = Eigen::Vector2d(8, 22);  // A (1, 2)
  EXPECT_LT((cholesky.solve(b) - Eigen::Vector2d(1, 2)).norm(), 1e-15);
  const MatrixXd inverse = symmetric(10.0 / 36, -2.0 / 36, 4.0 / 36);
  EXPECT_LT((cholesky.inverse() - inverse).norm(), 1e-15);
  const MatrixXd B = symmetric(4, 2, 10);
  EXPECT_LT((cholesky.solve(B) - MatrixXd::Identity(2, 2)).norm(), 1e-15);
}

TEST(Cholesky, TellsWhatIsNotPositiveDefinite) {
  EXPECT_FALSE(Cholesky(symmetric(1, 2, 1)).is_positive_definite());
  EXPECT_FALSE(Cholesky(symmetric(1, 1, 1)).is_positive_definite());
  EXPECT_FALSE(Cholesky(symmetric(-1, 0, 1)).is_positive_definite());
  EXPECT_TRUE(Cholesky(symmetric(1, 1, 1.001)).is_positive_definite());
}

// The pivots of this order are 1e-12 and 1; the other way round they are 1 and
// 1e-12. Either way no digit is lost but by the condition.
TEST(Cholesky, SolvesAGradedSystemInEitherOrder) {
  for (const MatrixXd& A :
       {symmetric(1e-12, 1e-7, 1), symmetric(1, 1e-7, 1e-12)}) {
    const VectorXd x = Eigen::Vector2d(3, -5);
    const VectorXd b = A * x;
    EXPECT_LT((A * Cholesky(A).solve(b) - b).norm(), 1e-15 * b.norm());
  }
}

}  // namespace
}  // namespace beamgyro::internal::cholesky_test
