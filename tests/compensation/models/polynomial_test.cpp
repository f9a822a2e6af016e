// SPDX-License-Identifier: MIT
#include "compensation/models/polynomial.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "compensation/methods/bias_model.h"
#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::polynomial_test {
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
  EXPECT_TRUE(holds(rejection([&] { fit_polynomial(x, x, 3); }),
                    "determine only 3 of its 4 coefficients"));
}

TEST(Polynomial, FurtherInputsAddStraightLines) {
  Eigen::ArrayXXd x(3, 3);
  x << 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, -1.0, 0.5, 2.0;
  const Polynomial p{{1.0, 2.0, 3.0}, {10.0, -4.0}};
  EXPECT_TRUE((p.predict(x) == Eigen::Array3d(1.0, 27.0, -1.0)).all());

  const Eigen::ArrayXd T = grid(-1.0, 1.0, 0.1);
  Eigen::ArrayXXd rows(T.size(), 3);
  rows << T, (3.0 * T).sin(), (5.0 * T).cos();
  const Polynomial q{{0.5, -1.0, 0.25, 2.0}, {0.75, -0.125}};
  for (const auto& fit : {fit_polynomial, fit_polynomial_by_normal_equations}) {
    const Polynomial found = fit(rows, q.predict(rows), 3);
    ASSERT_EQ(found.coefficients.size(), 4u);
    ASSERT_EQ(found.slopes.size(), 2u);
    for (std::size_t n = 0; n < 4; ++n)
      EXPECT_NEAR(found.coefficients[n], q.coefficients[n], 1e-12);
    for (std::size_t n = 0; n < 2; ++n)
      EXPECT_NEAR(found.slopes[n], q.slopes[n], 1e-12);
  }
}

double condition_of(const Eigen::ArrayXd& x, int degree) {
  Eigen::MatrixXd powers(x.size(), degree + 1);
  for (int n = 0; n <= degree; ++n) powers.col(n) = x.pow(n).matrix();
  const Eigen::VectorXd squares =
      reference::symmetric_modes(powers.transpose() * powers).values;
  return std::sqrt(squares(degree) / squares(0));
}

// Cholesky does not mind the scale of the powers. It minds their likeness,
// which grows with the distance from 25 degC over the width of the range.
TEST(Polynomial, NormalEquationsLoseDigitsWhereTheRangeLiesFarFrom25) {
  const auto loss = [&](const Eigen::ArrayXd& dT, int degree) {
    const Eigen::ArrayXd y = (dT / 65.0).pow(degree);
    const Polynomial p = fit_polynomial_by_normal_equations(dT, y, degree);
    return (p.predict(dT) - y).abs().maxCoeff();
  };
  const auto by_qr = [&](const Eigen::ArrayXd& dT, int degree) {
    const Scale scale = scale_to_unit(dT, "dT");
    const Eigen::ArrayXd x = (dT - scale.centre) / scale.half_width;
    const Eigen::ArrayXd y = (dT / 65.0).pow(degree);
    return (fit_polynomial(x, y, degree).predict(x) - y).abs().maxCoeff();
  };
  const Eigen::ArrayXd around = grid(-65.0, 60.0, 0.25),
                       beyond = grid(35.0, 60.0, 0.25);  // [K] from 25 degC
  EXPECT_GT(condition_of(around, 3), 1e4 * condition_of(around / 65.0, 3));
  EXPECT_LT(loss(around, 3), 1e-12);
  EXPECT_LT(loss(around, 7), 1e-11);
  EXPECT_LT(loss(beyond, 3), 1e-11);
  EXPECT_GT(loss(beyond, 7), 1e-9);
  EXPECT_LT(by_qr(beyond, 7), 1e-13);
  EXPECT_TRUE(holds(rejection([&] { loss(beyond, 12); }),
                    "cannot be solved in double precision"));
}

TEST(Polynomial, ShiftedIsTheSamePolynomialAboutAnotherOrigin) {
  const std::vector<double> p{0.5, -2.0, 0.75, 3.0, -0.25};
  const std::vector<double> q = shifted(p, 1.5);
  for (const double x : {-2.0, -0.3, 0.0, 1.0, 4.0}) {
    double at_p = 0.0, at_q = 0.0;
    for (std::size_t n = p.size(); n-- > 0;) {
      at_p = at_p * (x + 1.5) + p[n];
      at_q = at_q * x + q[n];
    }
    EXPECT_NEAR(at_q, at_p, 1e-11);
  }
  EXPECT_EQ(shifted({1.0, 2.0, 1.0}, -1.0),
            (std::vector<double>{0.0, 0.0, 1.0}));
  EXPECT_EQ(shifted({7.0}, 3.0), (std::vector<double>{7.0}));
}

TEST(BiasModel, CoefficientsAboutAReferenceAreInKelvins) {
  // b = 0.1 + 2 [1 - 3 z + z^2], z = (T - 5) / 45
  const BiasModel model{
      {{5.0, 45.0}}, {0.1, 2.0}, Polynomial{{1.0, -3.0, 1.0}}};
  const std::vector<double> c = coefficients_about(model, 35.0);
  ASSERT_EQ(c.size(), 3u);
  const double z = 30.0 / 45.0;
  EXPECT_NEAR(c[0], 0.1 + 2.0 * (1.0 - 3.0 * z + z * z), 1e-14);
  EXPECT_NEAR(c[1], 2.0 * (-3.0 + 2.0 * z) / 45.0, 1e-15);
  EXPECT_NEAR(c[2], 2.0 / 45.0 / 45.0, 1e-17);
  BiasModel sloped = model;
  sloped.input_scales.push_back({});
  sloped.function = Polynomial{{1.0, 2.0}, {3.0}};
  EXPECT_TRUE(holds(rejection([&] { coefficients_about(sloped, 25.0); }),
                    "this polynomial has 1 more inputs"));
}

TEST(BiasModel, EquationOneBelongsToAPolynomialOnly) {
  const BiasModel network{{Scale{}}, {}, BpNetwork({1, 2, 1})};
  EXPECT_TRUE(holds(rejection([&] { equation_one(network); }), "of kind bp"));
}

TEST(BiasModel, ConstantInputCannotBeScaled) {
  EXPECT_TRUE(holds(rejection([] {
                      scale_to_unit(Eigen::ArrayXd::Constant(4, 25.0),
                                    "input output");
                    }),
                    "input output is 25 in all 4 training rows"));
}

}  // namespace
}  // namespace beamgyro::internal::polynomial_test
