// SPDX-License-Identifier: MIT
#include "statistics/curve_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamgyro::internal::curve_family_test {
namespace {

// -20 to 50 degC in steps of 0.5 K.
constexpr Eigen::Index kCount = 141;
constexpr double kLow = -20, kHigh = 50;

Eigen::ArrayXd temperatures() {
  return Eigen::ArrayXd::LinSpaced(kCount, kLow, kHigh);
}

CurveFamily family_of(const Eigen::MatrixXd& curves) {
  return {temperatures(), curves};
}

CurveFamily one(const Eigen::ArrayXd& curve) {
  return family_of(curve.matrix().transpose());
}

CurveFigures figures_of(const Eigen::ArrayXd& curve) {
  return curve_figures(one(curve)).front();
}

/// A hill 1 / (1 + x^2) about `top`, `width` wide at half its height.
Eigen::ArrayXd hill(double top, double width) {
  return 1 / (1 + ((temperatures() - top) / (0.5 * width)).square());
}

// Squares of numbers near 1 are summed over 141 temperatures.
constexpr double kRounding = 1e-13;

}  // namespace

TEST(CurveFigures, APolynomialIsLeftByLowerDegreesOnly) {
  const Eigen::ArrayXd x = temperatures() / 35 - 0.4;
  const CurveFigures line = figures_of(3 - 2 * x);
  EXPECT_NEAR(line.left[0], 0, kRounding);
  EXPECT_NEAR(line.peak_to_peak, 4, kRounding);
  const CurveFigures cubic = figures_of(1 + x - x.square() + 2 * x.cube());
  EXPECT_GT(cubic.left[0], 0.01);
  EXPECT_NEAR(cubic.left[1], 0, kRounding);
  EXPECT_NEAR(cubic.left[2], 0, kRounding);
  const CurveFigures quintic = figures_of(x.cube() + x.square() * x.cube());
  EXPECT_GT(quintic.left[1], 0.001);
  EXPECT_NEAR(quintic.left[2], 0, kRounding);
}

// Of the continuous x^2 + a x on -1..1 the line leaves the parabola: its
// variance 4/45 over 4/45 + a^2/3. On n even points both change by 1/n.
TEST(CurveFigures, ShareOfALineIsThatOfTheParabolaBesideIt) {
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(kCount, -1, 1);
  constexpr double kSlope = 0.4;
  const double expected = (4. / 45) / (4. / 45 + kSlope * kSlope / 3);
  EXPECT_NEAR(figures_of(x.square() + kSlope * x).left[0], expected,
              2. / kCount);
}

TEST(CurveFigures, DoNotDependOnOffsetAndScale) {
  const Eigen::ArrayXd curve = hill(8, 5) + 0.01 * temperatures();
  const CurveFigures first = figures_of(curve),
                     second = figures_of(7 - 40 * curve);
  EXPECT_NEAR(second.peak_to_peak, 40 * first.peak_to_peak, 1e-11);
  for (std::size_t i = 0; i < first.left.size(); ++i)
    EXPECT_NEAR(second.left[i], first.left[i], 1e-12);
  EXPECT_NEAR(second.kink, first.kink, 1e-12);
}

// At the top of a hill: 2 - 2 / (1 + (6/w)^2), over its top less its end.
TEST(CurveFigures, KinkOfAHillIsItsSecondDifferenceAtTheTop) {
  for (const double width : {4.0, 10.0}) {
    const double reach = std::pow(6 / width, 2);
    const double foot = 1 / (1 + std::pow(80 / width, 2));  // at -20 degC
    const CurveFigures found = figures_of(hill(20, width));
    EXPECT_NEAR(found.peak_to_peak, 1 - foot, 1e-15);
    EXPECT_NEAR(found.kink, 2 * reach / (1 + reach) / (1 - foot), 1e-14)
        << width;
  }
}

TEST(CurveFigures, KinkOfAStraightLineIsZeroAndOfAnEdgeIsKnown) {
  EXPECT_NEAR(figures_of(temperatures()).kink, 0, 1e-15);
  // |T - 10| bends at 10: 3 + 3 over 40.
  EXPECT_NEAR(figures_of((temperatures() - 10).abs()).kink, 0.15, 1e-15);
  // The last middle is 47: of the 2 K that rise from 48 it sees the top alone.
  EXPECT_NEAR(figures_of((temperatures() - 48).max(0)).kink, 1, 1e-15);
}

// Where 3 K is no multiple of the step the curve is straight between two
// temperatures.
TEST(CurveFigures, KinkUsesStraightLinesBetweenTemperatures) {
  CurveFamily family;
  family.temperature = Eigen::VectorXd::LinSpaced(11, -10, 10);  // step 2
  family.curves = family.temperature.array().square().transpose();
  // b(3) is half of b(2) + b(4), 10: 2 * 10 over 100, at T = 0; elsewhere the
  // same parabola adds the same.
  EXPECT_NEAR(curve_figures(family).front().kink, 0.2, 1e-15);
}

TEST(CurveFigures, OfAFlatCurveHaveNoShares) {
  const CurveFigures flat = figures_of(Eigen::ArrayXd::Constant(kCount, 0.1));
  EXPECT_EQ(flat.peak_to_peak, 0);
  for (const double share : flat.left) EXPECT_TRUE(std::isnan(share));
  EXPECT_TRUE(std::isnan(flat.kink));
}

TEST(CurveFigures, OverAShortRangeHaveNoKink) {
  const CurveFamily part = within(one(hill(20, 5)), 17.5, 23);
  EXPECT_TRUE(std::isnan(curve_figures(part).front().kink));
  EXPECT_FALSE(
      std::isnan(curve_figures(within(one(hill(20, 5)), 17, 23)).front().kink));
}

TEST(CurveFamily, PartsHaveBothEnds) {
  const CurveFamily part = within(one(temperatures()), -10, 25);
  EXPECT_EQ(part.temperature(0), -10);
  EXPECT_EQ(part.temperature(part.temperature.size() - 1), 25);
  EXPECT_EQ(part.curves.cols(), 71);
  EXPECT_EQ(within(part, 30, 40).curves.cols(), 0);
  EXPECT_EQ(within(part, -10.2, -10.1).temperature.size(), 0);
}

TEST(CurveFamily, CurvesAreZeroAtATemperatureBetweenTwo) {
  const Eigen::ArrayXd line = 2 + 0.5 * temperatures();
  for (const double zero : {-20.0, 25.0, 25.2, 50.0}) {
    const CurveFamily zeroed = zeroed_at(one(line), zero);
    EXPECT_NEAR(zeroed.curves(0, 0), 0.5 * (-20 - zero), 1e-14);
    EXPECT_NEAR(zeroed.curves(0, kCount - 1), 0.5 * (50 - zero), 1e-14);
  }
}

TEST(CurveFamily, RoundedValuesAreMultiplesOfTheStep) {
  const CurveFamily rounded = rounded_to(one(0.01 * temperatures()), 0.0625);
  EXPECT_EQ(rounded.curves(0, 0), -0.1875);         // of -0.2
  EXPECT_EQ(rounded.curves(0, kCount - 1), 0.5);    // of 0.5
  EXPECT_EQ(rounded.curves(0, kCount / 2), 0.125);  // of 0.15
}

TEST(CurveModes, OfMultiplesOfOneCurveAreOneComponent) {
  Eigen::MatrixXd curves(4, kCount);
  for (int i = 0; i < 4; ++i)
    curves.row(i) = (10 * i + (i - 1.5) * hill(5, 20)).matrix().transpose();
  const CurveModes modes = curve_modes(family_of(curves));
  EXPECT_NEAR(modes.component_shares.at(0), 1, kRounding);
  EXPECT_NEAR(modes.component_shares.at(1), 0, kRounding);
  EXPECT_NEAR(modes.mean_curve_share, 0, kRounding);
}

// Two orthogonal shapes of equal norm in amounts +-2 and +-1.
TEST(CurveModes, SharesAreThoseOfTheVariancesOfOrthogonalShapes) {
  const Eigen::ArrayXd phase =
      2 * std::numbers::pi * Eigen::ArrayXd::LinSpaced(kCount, 0, kCount - 1) /
      kCount;
  const Eigen::MatrixXd shapes =
      (Eigen::MatrixXd(kCount, 2) << phase.sin(), phase.cos()).finished();
  Eigen::MatrixXd curves(4, kCount);
  curves.row(0) = 2 * shapes.col(0) + shapes.col(1);
  curves.row(1) = 2 * shapes.col(0) - shapes.col(1);
  curves.row(2) = -2 * shapes.col(0) + shapes.col(1);
  curves.row(3) = -2 * shapes.col(0) - shapes.col(1);
  const CurveModes modes = curve_modes(family_of(curves));
  EXPECT_NEAR(modes.component_shares.at(0), 0.8, kRounding);
  EXPECT_NEAR(modes.component_shares.at(1), 0.2, kRounding);
  // A mean of norm 1 beside a variance of 4 + 1.
  curves.rowwise() += phase.sin().matrix().transpose();
  EXPECT_NEAR(curve_modes(family_of(curves)).mean_curve_share, 1. / 6,
              kRounding);
  // More units than temperatures: the products of the other side.
  Eigen::MatrixXd many(400, kCount);
  for (int i = 0; i < 400; ++i) many.row(i) = curves.row(i % 4);
  const CurveModes same = curve_modes(family_of(many));
  EXPECT_NEAR(same.component_shares.at(0), 0.8, kRounding);
  EXPECT_EQ(same.component_shares.size(), kMostComponents);
}

TEST(CurveModes, OfEqualAndOfFlatCurvesHaveNoComponents) {
  const CurveModes equal =
      curve_modes(family_of(hill(0, 9).matrix().transpose().replicate(3, 1)));
  EXPECT_NEAR(equal.mean_curve_share, 1, kRounding);
  EXPECT_TRUE(equal.component_shares.empty());
  const CurveModes flat =
      curve_modes(family_of(Eigen::MatrixXd::Constant(3, kCount, 0.5)));
  EXPECT_TRUE(std::isnan(flat.mean_curve_share));
  EXPECT_TRUE(flat.component_shares.empty());
}

}  // namespace beamgyro::internal::curve_family_test
