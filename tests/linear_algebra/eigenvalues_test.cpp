// SPDX-License-Identifier: MIT
#include "linear_algebra/eigenvalues.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beamgyro::internal::eigenvalues_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(SymmetricEigen, IsTheClosedFormOfTwoRows) {
  MatrixXd A(2, 2);
  A << 2, 1e300, 1, 2;  // the lower triangle counts
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_LT((eigen.values - Eigen::Vector2d(1, 3)).norm(), 1e-15);
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(eigen.vectors(0, 0) * eigen.vectors(1, 0), -0.5, 1e-15);
  EXPECT_NEAR(std::abs(eigen.vectors(0, 1)), half, 1e-15);
  EXPECT_NEAR(eigen.vectors(0, 1), eigen.vectors(1, 1), 1e-15);
}

// Of v v^T: v^2 along v, and 0 twice.
TEST(SymmetricEigen, OfASingularMatrixHasValuesOfZero) {
  const VectorXd v = Eigen::Vector3d(1, 2, 2);
  const SymmetricEigen eigen = symmetric_eigen(v * v.transpose());
  EXPECT_LT((eigen.values - Eigen::Vector3d(0, 0, 9)).norm(), 1e-14);
  EXPECT_NEAR(std::abs(eigen.vectors.col(2).dot(v)), 3, 1e-14);
  EXPECT_LT(
      (eigen.vectors * eigen.vectors.transpose() - MatrixXd::Identity(3, 3))
          .norm(),
      1e-14);
}

TEST(EigenvaluesOf, AreImaginaryOfARotation) {
  MatrixXd A(2, 2);
  A << 0, -3, 3, 0;
  const Eigen::VectorXcd values = eigenvalues_of(A);
  EXPECT_LT(values.real().cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(values(0).imag() * values(1).imag(), -9, 1e-13);
}

// Of x^3 - 6 x^2 + 11 x - 6 = (x - 1) (x - 2) (x - 3).
TEST(EigenvaluesOf, AreTheRootsOfACompanionMatrix) {
  MatrixXd companion(3, 3);
  companion << 0, 0, 6, 1, 0, -11, 0, 1, 6;
  const Eigen::VectorXcd values = eigenvalues_of(companion);
  VectorXd roots = values.real();
  std::sort(roots.begin(), roots.end());
  EXPECT_LT((roots - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT(values.imag().norm(), 1e-12);
}

}  // namespace
}  // namespace beamgyro::internal::eigenvalues_test
