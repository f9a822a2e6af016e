// SPDX-License-Identifier: MIT
#include "linear_algebra/linear_systems.h"

#include <gtest/gtest.h>

#include <complex>
#include <limits>

namespace beamgyro::internal::linear_systems_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kEps = std::numeric_limits<double>::epsilon();

MatrixXd matrix_2x2(double a, double b, double c, double d) {
  MatrixXd A(2, 2);
  A << a, b, c, d;
  return A;
}

// Has a one in each row, off the diagonal, and moves x(i) to x(i + 1).
MatrixXd shift(Index n) {
  MatrixXd A = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i) A((i + 1) % n, i) = 1.0;
  return A;
}

TEST(SolveSystem, ExchangesRowsWhereTheFirstPivotIsZero) {
  const MatrixXd X =
      solve_system(matrix_2x2(0, 1, 2, 3), matrix_2x2(5, 1, 19, 5));
  EXPECT_EQ(X, matrix_2x2(2, 1, 5, 1));
}

// Without the exchange the element 1e-20 loses all digits of the other row.
TEST(SolveSystem, ExchangesRowsWhereTheFirstPivotIsSmall) {
  const MatrixXd x =
      solve_system(matrix_2x2(1e-20, 1, 1, 1), Eigen::Vector2d(1, 2));
  EXPECT_NEAR(x(0), 1.0, 4 * kEps);
  EXPECT_NEAR(x(1), 1.0, 4 * kEps);
}

// LU with pivoting is backward stable: the residual is small, the error is
// that times the condition, 1.5e10 for eight rows.
TEST(SolveSystem, LeavesASmallResidualOfAnIllConditionedMatrix) {
  const Index n = 8;
  MatrixXd hilbert(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      hilbert(i, j) = 1.0 / static_cast<double>(i + j + 1);
  const MatrixXd b = hilbert.rowwise().sum();
  const MatrixXd x = solve_system(hilbert, b);
  const auto rows = static_cast<double>(n);
  EXPECT_LT((hilbert * x - b).norm(), rows * kEps * hilbert.norm() * x.norm());
  EXPECT_LT((x.array() - 1.0).abs().maxCoeff(), 1.5e10 * rows * kEps);
}

TEST(SolveSystem, MarksASingularMatrixByWhatIsNotFinite) {
  EXPECT_FALSE(
      solve_system(matrix_2x2(1, 2, 2, 4), Eigen::Vector2d(1, 1)).allFinite());
}

TEST(SolveSystem, SolvesFourAndSixRowsOfFixedSize) {
  const Eigen::Vector4d four(4, 1, 2, 3);
  EXPECT_EQ(solve_system(Eigen::Matrix4d(2.0 * shift(4)), four),
            Eigen::Vector4d(0.5, 1, 1.5, 2));
  Eigen::Vector<double, 6> six, shifted;
  six << 1, 2, 3, 4, 5, 6;
  shifted << 6, 1, 2, 3, 4, 5;
  EXPECT_EQ(solve_system(Eigen::Matrix<double, 6, 6>(shift(6)), shifted), six);
}

TEST(InverseOf, IsTheClosedFormOfTwoRows) {
  const MatrixXd inverse = inverse_of(matrix_2x2(4, 7, 2, 6));
  EXPECT_LT((inverse - matrix_2x2(0.6, -0.7, -0.2, 0.4)).norm(), 10 * kEps);
}

// Of determinant i (1 + i) - (2)(1) = -3 + i.
TEST(InverseOf, IsTheClosedFormOfTwoComplexRows) {
  using Complex = std::complex<double>;
  Eigen::Matrix2cd A, adjugate;
  A << Complex(0, 1), 2, 1, Complex(1, 1);
  adjugate << Complex(1, 1), -2, -1, Complex(0, 1);
  EXPECT_LT((inverse_of(A) - adjugate / Complex(-3, 1)).norm(), 4 * kEps);
  EXPECT_FALSE(inverse_of(Eigen::Matrix2cd::Zero().eval()).allFinite());
}

TEST(LuFactors, ServeOneMatrixAfterAnother) {
  LuFactors factors(2);
  ASSERT_TRUE(factors.factorise(matrix_2x2(0, 1, 2, 3)));
  EXPECT_EQ(factors.solve(Eigen::Vector2d(5, 19)), Eigen::Vector2d(2, 5));
  EXPECT_EQ(factors.solve(Eigen::Vector2d(1, 5)), Eigen::Vector2d(1, 1));
  ASSERT_TRUE(factors.factorise(matrix_2x2(4, 0, 0, 2)));
  EXPECT_EQ(factors.solve(Eigen::Vector2d(4, 4)), Eigen::Vector2d(1, 2));
}

TEST(LuFactors, TellASingularMatrix) {
  LuFactors factors(2);
  EXPECT_FALSE(factors.factorise(matrix_2x2(1, 2, 2, 4)));
  EXPECT_FALSE(factors.factorise(matrix_2x2(0, 0, 0, 0)));
  EXPECT_TRUE(factors.factorise(matrix_2x2(1, 2, 2, 5)));
}

}  // namespace
}  // namespace beamgyro::internal::linear_systems_test
