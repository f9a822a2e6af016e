// SPDX-License-Identifier: MIT
#include "compensation/models/cubic_spline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/methods/bias_model.h"
#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::cubic_spline_test {
namespace {

using Eigen::ArrayXd;

double rms(const ArrayXd& values) { return std::sqrt(values.square().mean()); }

TEST(CubicSpline, NotAKnotReproducesACubic) {
  const auto cubic = [](const ArrayXd& x) -> ArrayXd {
    return 1.0 - 0.3 * x + 2e-2 * x.square() - 4e-4 * x.cube();
  };
  const ArrayXd knots = grid(-40.0, 50.0, 7.5);
  const CubicSpline spline =
      fit_cubic_spline(knots, cubic(knots), knots, SplineEnd::kNotAKnot);
  const ArrayXd dense = grid(-45.0, 55.0, 0.25);  // beyond the ends too
  EXPECT_LT((spline.predict(dense) - cubic(dense)).abs().maxCoeff(), 1e-11);
}

TEST(CubicSpline, NaturalReproducesAStraightLineAndIsStraightAtItsEnds) {
  const ArrayXd knots = grid(-40.0, 50.0, 10.0);
  const CubicSpline line =
      fit_cubic_spline(knots, 2.0 - 0.1 * knots, knots, SplineEnd::kNatural);
  EXPECT_LT(line.second_derivatives.abs().maxCoeff(), 1e-14);
  const CubicSpline curve =
      fit_cubic_spline(knots, bias_curve(knots), knots, SplineEnd::kNatural);
  EXPECT_NEAR(curve.second_derivatives(0), 0.0, 1e-15);
  EXPECT_NEAR(curve.second_derivatives(9), 0.0, 1e-15);
  EXPECT_GT(curve.second_derivatives.abs().maxCoeff(), 1e-3);
}

TEST(CubicSpline, GoesThroughOnePointPerKnot) {
  const ArrayXd knots = grid(-40.0, 50.0, 5.0);
  const CubicSpline spline =
      fit_cubic_spline(knots, bias_curve(knots), knots, SplineEnd::kNotAKnot);
  EXPECT_LT((spline.predict(knots) - bias_curve(knots)).abs().maxCoeff(),
            1e-13);
}

// s' and s'' from second differences on both sides of every inner knot.
TEST(CubicSpline, HasTwoContinuousDerivatives) {
  const ArrayXd knots = grid(-40.0, 50.0, 10.0);
  const CubicSpline spline =
      fit_cubic_spline(knots, bias_curve(knots), knots, SplineEnd::kNotAKnot);
  const double h = 0.01;  // [K]
  for (Eigen::Index k = 1; k + 1 < knots.size(); ++k) {
    const ArrayXd x = knots(k) + h * ArrayXd::LinSpaced(5, -2.0, 2.0);
    const ArrayXd y = spline.predict(x);
    const double left = (y(0) - 2.0 * y(1) + y(2)) / (h * h);
    const double right = (y(2) - 2.0 * y(3) + y(4)) / (h * h);
    EXPECT_NEAR(left, spline.second_derivatives(k), 1e-3);
    EXPECT_NEAR(right, spline.second_derivatives(k), 1e-3);
    EXPECT_NEAR((y(2) - y(1)) / h, (y(3) - y(2)) / h, 1e-3);
  }
}

TEST(Verification, V43SplineOnA5KGridBeatsTheCubicAHundredfold) {
  const ArrayXd T = grid(-40.0, 50.0, 5.0), dense = grid(-40.0, 50.0, 0.1);
  const CubicSpline spline = fit_cubic_spline(
      T, bias_curve(T), spline_knots(T, 5.0), SplineEnd::kNotAKnot);
  const double spline_rms = rms(spline.predict(dense) - bias_curve(dense));
  EXPECT_LT(spline_rms, 0.0032);
  const Polynomial cubic = fit_polynomial((T - 5.0) / 45.0, bias_curve(T), 3);
  EXPECT_NEAR(rms(cubic.predict((dense - 5.0) / 45.0) - bias_curve(dense)),
              0.39, 0.039);
}

TEST(CubicSpline, LeastSquaresAveragesRepeatedPoints) {
  const ArrayXd knots = grid(-40.0, 50.0, 10.0);
  ArrayXd x(20), y(20);
  x << knots, knots;
  y << bias_curve(knots) + 0.1, bias_curve(knots) - 0.1;
  const CubicSpline spline =
      fit_cubic_spline(x, y, knots, SplineEnd::kNotAKnot);
  EXPECT_LT((spline.values - bias_curve(knots)).abs().maxCoeff(), 1e-12);
}

TEST(SplineKnots, SoaksGetOneKnotEachAtTheirMean) {
  ArrayXd x(9);
  x << -10.1, 0.0, 10.2, -9.9, 0.2, 10.0, -10.0, 0.1, 10.1;
  const ArrayXd knots = spline_knots(x, 5.0);
  ASSERT_EQ(knots.size(), 3);
  EXPECT_NEAR(knots(0), -10.0, 1e-12);
  EXPECT_NEAR(knots(1), 0.1, 1e-12);
  EXPECT_NEAR(knots(2), 10.1, 1e-12);
}

TEST(SplineKnots, RampsGetEvenKnotsFromEndToEnd) {
  const ArrayXd knots = spline_knots(grid(-38.0, 51.0, 0.5), 5.0);
  ASSERT_EQ(knots.size(), 19);  // 89 K in 18 steps
  EXPECT_EQ(knots(0), -38.0);
  EXPECT_EQ(knots(18), 51.0);
  for (Eigen::Index k = 1; k < 19; ++k)
    EXPECT_NEAR(knots(k) - knots(k - 1), 89.0 / 18.0, 1e-12);
}

TEST(CubicSpline, FitsARampOfNoisyPointsBelowTheirNoise) {
  const ArrayXd T = grid(-40.0, 50.0, 0.25);
  ArrayXd y = bias_curve(T);
  RandomStream random(3, 0, 0, RandomPurpose{0});
  for (double& label : y) label += 0.02 * random.normal();
  const CubicSpline spline =
      fit_cubic_spline(T, y, spline_knots(T, 5.0), SplineEnd::kNotAKnot);
  // 19 free values on 361 points leave 0.02 sqrt(19 / 361) = 0.0046.
  EXPECT_LT(rms(spline.predict(T) - bias_curve(T)), 0.007);
}

TEST(CubicSpline, RejectsKnotsTheDataCannotDetermine) {
  const ArrayXd T = grid(0.0, 10.0, 5.0);
  EXPECT_TRUE(
      holds(rejection([&] { fit_cubic_spline(T, T, T, SplineEnd::kNatural); }),
            "3 knots from the data, at least 4"));
  const ArrayXd knots = grid(0.0, 30.0, 5.0);
  EXPECT_TRUE(holds(
      rejection([&] { fit_cubic_spline(T, T, knots, SplineEnd::kNatural); }),
      "determine the values at only 3 of the 7 knots"));
  ArrayXd backwards(4);
  backwards << 0.0, 10.0, 5.0, 20.0;
  EXPECT_TRUE(holds(rejection([&] {
                      fit_cubic_spline(T, T, backwards, SplineEnd::kNatural);
                    }),
                    "knots must increase"));
}

}  // namespace
}  // namespace beamgyro::internal::cubic_spline_test
