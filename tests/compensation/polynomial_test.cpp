// SPDX-License-Identifier: MIT
#include "compensation/polynomial.h"

#include <gtest/gtest.h>

#include "compensation/bias_model.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/message_of.h"

namespace beamgyro {
namespace {

BiasModel fit_scaled(const Eigen::ArrayXd& T, const Eigen::ArrayXd& bias,
                     int degree) {
  const Scale scale = scale_to_unit(T, "temperature");
  return {{scale},
          {},
          fit_polynomial((T - scale.centre) / scale.half_width, bias, degree)};
}

TEST(Polynomial, RecoversTheCoefficientsOfEquationOne) {
  const double F0 = 0.52, a1 = 3e-2, a2 = -4e-4, a3 = 7e-6;
  const Eigen::ArrayXd T = grid(-40.0, 50.0, 5.0);
  const Eigen::ArrayXd dT = T - kReferenceTemperature;
  const EquationOne found = equation_one(fit_scaled(
      T, F0 * (1.0 + a1 * dT + a2 * dT.square() + a3 * dT.cube()), 3));
  EXPECT_NEAR(found.bias_at_reference, F0, 1e-13);
  ASSERT_EQ(found.coefficients.size(), 3u);
  EXPECT_NEAR(found.coefficients[0], a1, 1e-12 * a1);
  EXPECT_NEAR(found.coefficients[1], a2, -1e-12 * a2);
  EXPECT_NEAR(found.coefficients[2], a3, 1e-12 * a3);
}

TEST(Polynomial, HighDegreeStaysExactThanksToTheScaledVariable) {
  const Eigen::ArrayXd T = grid(-40.0, 50.0, 2.5);
  const Eigen::ArrayXd x = (T - 5.0) / 45.0;
  const Eigen::ArrayXd bias = x.pow(12.0) - 2.0 * x.pow(7.0) + 0.3;
  const BiasModel model = fit_scaled(T, bias, 12);
  EXPECT_LT((model.predict(T) - bias).abs().maxCoeff(), 1e-12);
}

TEST(Polynomial, ResidualIsOrthogonalToThePowers) {
  const Eigen::ArrayXd T = grid(-40.0, 50.0, 5.0);
  const Eigen::ArrayXd residual =
      bias_curve(T) - fit_scaled(T, bias_curve(T), 3).predict(T);
  for (int n = 0; n <= 3; ++n)
    EXPECT_NEAR((residual * ((T - 5.0) / 45.0).pow(n)).sum(), 0.0, 1e-12) << n;
}

TEST(Polynomial, TooFewTemperaturesAreRejected) {
  Eigen::ArrayXd x(5);
  x << -1.0, -1.0, 0.5, 0.5, 1.0;
  EXPECT_NE(message_of([&] {
              fit_polynomial(x, x, 3);
            }).find("determine only 3 of its 4 coefficients"),
            std::string::npos);
}

TEST(BiasModel, EquationOneBelongsToAPolynomialOnly) {
  const BiasModel network{{Scale{}}, {}, BpNetwork({1, 2, 1})};
  EXPECT_NE(message_of([&] { equation_one(network); }).find("of kind bp"),
            std::string::npos);
}

TEST(BiasModel, ConstantInputCannotBeScaled) {
  EXPECT_NE(message_of([] {
              scale_to_unit(Eigen::ArrayXd::Constant(4, 25.0), "input output");
            }).find("input output is 25 in all 4 training rows"),
            std::string::npos);
}

}  // namespace
}  // namespace beamgyro
