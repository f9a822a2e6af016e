// SPDX-License-Identifier: MIT
#include "linear_algebra/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beamgyro::internal::least_squares_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The line a + b t through (0, 0), (1, 1) and (2, 3): a = -1/6, b = 3/2.
MatrixXd line_terms() {
  MatrixXd A(3, 2);
  A << 1, 0, 1, 1, 1, 2;
  return A;
}
VectorXd line_values() { return Eigen::Vector3d(0, 1, 3); }
const Eigen::Vector2d kLine(-1.0 / 6, 1.5);

MatrixXd twice_the_same_column() { return MatrixXd::Ones(2, 2); }

// Of Laeuchli: A^T A is singular in double precision, and A is of the rank 2.
MatrixXd laeuchli(double e) {
  MatrixXd A(3, 2);
  A << 1, 1, e, 0, 0, e;
  return A;
}

TEST(LeastSquares, FitsALine) {
  const LeastSquares fit = least_squares(line_terms(), line_values());
  EXPECT_LT((fit.x - kLine).norm(), 1e-14);
  EXPECT_EQ(fit.rank, 2);
}

TEST(LeastSquares, CountsTheColumnsThatAreIndependent) {
  const LeastSquares fit =
      least_squares(twice_the_same_column(), Eigen::Vector2d(2, 2));
  EXPECT_EQ(fit.rank, 1);
  EXPECT_NEAR(fit.x(0), 2, 1e-14);
  EXPECT_EQ(fit.x(1), 0);
}

TEST(LeastSquares, SolvesWhatNormalEquationsCannot) {
  const double e = 1e-9;  // the condition is 1.4e9
  const MatrixXd A = laeuchli(e);
  const VectorXd b = Eigen::Vector3d(3, e, 2 * e);
  const LeastSquares fit = least_squares(A, b);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_LT((fit.x - Eigen::Vector2d(1, 2)).norm(), 1e-6);
  EXPECT_LT((full_rank_solution(A, b).x - Eigen::Vector2d(1, 2)).norm(), 1e-6);
  EXPECT_LT((least_norm_solution(A, b) - Eigen::Vector2d(1, 2)).norm(), 1e-6);
}

TEST(LeastNormSolution, IsTheShortestOfAll) {
  EXPECT_LT((least_norm_solution(line_terms(), line_values()) - kLine).norm(),
            1e-14);
  const VectorXd x =
      least_norm_solution(twice_the_same_column(), Eigen::Vector2d(2, 2));
  EXPECT_LT((x - Eigen::Vector2d(1, 1)).norm(), 1e-14);
  EXPECT_EQ(least_norm_solution(MatrixXd::Zero(2, 2), Eigen::Vector2d(1, 1)),
            Eigen::Vector2d(0, 0));
}

TEST(FullRankSolution, HasTheRootOfTheNormalEquations) {
  const MatrixXd A = line_terms();
  const FullRankSolution fit = full_rank_solution(A, line_values());
  EXPECT_LT((fit.x - kLine).norm(), 1e-14);
  EXPECT_EQ(fit.R(1, 0), 0);
  EXPECT_LT((fit.R.transpose() * fit.R - A.transpose() * A).norm(), 1e-14);
}

TEST(UpperFactor, HasAsManyRowsAsTheSmallerSide) {
  const MatrixXd tall = upper_factor(Eigen::Vector2d(3, 4));
  ASSERT_EQ(tall.size(), 1);
  EXPECT_DOUBLE_EQ(std::abs(tall(0, 0)), 5);
  const MatrixXd wide = upper_factor(Eigen::RowVector2d(3, 4));
  ASSERT_EQ(wide.rows(), 1);
  ASSERT_EQ(wide.cols(), 2);
  EXPECT_DOUBLE_EQ(wide(0, 1) / wide(0, 0), 4.0 / 3);
  EXPECT_DOUBLE_EQ(wide.norm(), 5);
}

TEST(UpperFactor, IsZeroBelowTheDiagonalOfASingularMatrix) {
  const MatrixXd R = upper_factor(twice_the_same_column());
  EXPECT_EQ(R(1, 0), 0);
  EXPECT_NEAR(R(1, 1), 0, 1e-15);
  EXPECT_LT((R.transpose() * R - MatrixXd::Constant(2, 2, 2)).norm(), 1e-14);
}

}  // namespace
}  // namespace beamgyro::internal::least_squares_test
