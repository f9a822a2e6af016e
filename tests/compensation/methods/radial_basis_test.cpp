// SPDX-License-Identifier: MIT
#include "compensation/methods/radial_basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "compensation/methods/bias_model.h"

namespace beamgyro::internal::radial_basis_test {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;

// Points of a square grid over [-1, 1] x [-1, 1].
ArrayXXd square_grid(int side) {
  ArrayXXd x(side * side, 2);
  for (int i = 0; i < side * side; ++i)
    x.row(i) << -1.0 + 2.0 * (i % side) / (side - 1),
        -1.0 + 2.0 * std::floor(i / static_cast<double>(side)) / (side - 1);
  return x;
}

TEST(RadialBasis, IsAPlaneAndBellsAboutItsCentres) {
  RadialBasis f{Eigen::MatrixXd(2, 2), 0.5, Eigen::Vector3d(0.3, -1.0, 2.0),
                Eigen::Vector2d(1.5, -0.5)};
  f.centres << 0.0, 0.0, 1.0, -1.0;
  ArrayXXd x(2, 2);
  x << 0.0, 0.0, 0.5, -0.5;
  const ArrayXd y = f.predict(x);
  // |x - c|^2 is 0 and 2 at the first point, 0.5 and 0.5 at the second.
  EXPECT_NEAR(y(0), 0.3 + 1.5 - 0.5 * std::exp(-4.0), 1e-15);
  EXPECT_NEAR(y(1), 0.3 - 0.5 - 1.0 + (1.5 - 0.5) * std::exp(-1.0), 1e-15);
}

TEST(RadialBasis, APlaneIsReproducedWithoutBells) {
  const ArrayXXd x = square_grid(9);
  const ArrayXd y = 0.7 - 0.2 * x.col(0) + 1.1 * x.col(1);
  const RadialBasis f = fit_radial_basis(x, y, 6, 1.5, 1e-6);
  EXPECT_LT((f.predict(x) - y).abs().maxCoeff(), 1e-9);
  EXPECT_LT(f.weights.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(RadialBasis, CentresAreSpreadOverThePoints) {
  const RadialBasis f = fit_radial_basis(
      square_grid(9), square_grid(9).col(0).square(), 5, 1.5, 1e-6);
  Eigen::MatrixXd expected(5, 2);  // the middle, then the corners
  expected << 0, 0, -1, -1, 1, -1, -1, 1, 1, 1;
  EXPECT_EQ(f.centres, expected);
  EXPECT_NEAR(f.width, 1.5 * std::sqrt(2.0), 1e-12);
}

TEST(RadialBasis, ItsOwnKindIsFoundAgain) {
  const ArrayXXd x = square_grid(15);
  RadialBasis truth =
      fit_radial_basis(x, ArrayXd::Zero(x.rows()), 5, 1.5, 1e-6);
  truth.plane << 0.4, 0.1, -0.3;
  truth.weights << 0.5, -0.2, 0.3, 0.1, -0.4;
  const ArrayXd y = truth.predict(x);
  // What a ridge r leaves out shrinks with it.
  const auto error = [&](double ridge) {
    return (fit_radial_basis(x, y, 5, 1.5, ridge).predict(x) - y)
        .abs()
        .maxCoeff();
  };
  EXPECT_LT(error(1e-12), 1e-6);
  EXPECT_LT(error(1e-12), error(1e-4));
}

TEST(RadialBasis, EqualPointsAreOneCentreAndASinglePlaceIsRefused) {
  ArrayXXd x(6, 1);
  x << -1, -1, 0, 0, 1, 1;
  const ArrayXd y = x.col(0).square();
  EXPECT_EQ(fit_radial_basis(x, y, 100, 1.5, 1e-6).centres.rows(), 3);
  EXPECT_THROW(
      fit_radial_basis(ArrayXXd::Zero(4, 1), ArrayXd::Ones(4), 2, 1.5, 1e-6),
      std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::radial_basis_test
