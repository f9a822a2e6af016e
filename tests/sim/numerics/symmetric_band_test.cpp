// SPDX-License-Identifier: MIT
#include "sim/numerics/symmetric_band.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::symmetric_band_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Irregular numbers in (-1, 1).
double irregular(Index i) {
  return 2 * std::fmod(static_cast<double>(i + 1) * 0.7548776662466927, 1.0) -
         1;
}

SymmetricBand irregular_band(Index n) {
  SymmetricBand A(n);
  for (Index i = 0; i < A.diagonals.size(); ++i)
    A.diagonals.data()[i] = irregular(i);
  return A;
}

VectorXd irregular_vector(Index n) {
  VectorXd x(n);
  for (Index i = 0; i < n; ++i) x(i) = irregular(i * i + 3);
  return x;
}

TEST(SymmetricBand, IsTheDenseMatrixWithItsDiagonals) {
  const MatrixXd A = irregular_band(6).dense();
  EXPECT_EQ(A, A.transpose());
  EXPECT_EQ(A(4, 1), irregular(3 * 6 + 1));
  EXPECT_EQ(A(4, 0), 0);
  for (const Index n : {1, 2, 3, 4, 5, 40}) {
    const SymmetricBand band = irregular_band(n);
    const VectorXd x = irregular_vector(n);
    EXPECT_LT((band * x - band.dense() * x).norm(), 1e-14) << n;
  }
}

TEST(SymmetricBand, SolvesIndefiniteSystemsThatNeedPivots) {
  for (const Index n : {1, 2, 3, 4, 5, 40}) {
    SymmetricBand band = irregular_band(n);
    if (n > 1) band.diagonals(0, 0) = 0;
    const VectorXd b = irregular_vector(n);
    const auto x = solved(band, b);
    ASSERT_TRUE(x) << n;
    const VectorXd want = reference::solution(band.dense(), b);
    EXPECT_LT((*x - want).norm(), 1e-10 * want.norm()) << n;
  }
}

TEST(SymmetricBand, ASingularMatrixHasNoSolution) {
  SymmetricBand band = irregular_band(8);
  band.diagonals.row(3).setZero();
  for (Index d = 1; d <= 3; ++d) band.diagonals(3 - d, d) = 0;
  EXPECT_FALSE(solved(band, irregular_vector(8)));
}

}  // namespace
}  // namespace beamgyro::internal::symmetric_band_test
