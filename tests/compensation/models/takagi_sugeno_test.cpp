// SPDX-License-Identifier: MIT
#include "compensation/models/takagi_sugeno.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::takagi_sugeno_test {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;

TEST(TakagiSugeno, BlendsItsRulesByGaussianMemberships) {
  TakagiSugeno model;
  model.centres = ArrayXd::LinSpaced(2, -1.0, 1.0);
  model.width = 0.5;
  model.consequents = Eigen::MatrixXd(2, 3);
  model.consequents << 1.0, 2.0, 3.0, -4.0, 5.0, 0.5;
  ArrayXXd x(1, 2);
  x << 0.25, -0.6;
  const double low = std::exp(-0.5 * std::pow(1.25 / 0.5, 2)),
               high = std::exp(-0.5 * std::pow(0.75 / 0.5, 2));
  const double expected = (low * (1.0 + 2.0 * 0.25 - 3.0 * 0.6) +
                           high * (-4.0 + 5.0 * 0.25 - 0.5 * 0.6)) /
                          (low + high);
  EXPECT_NEAR(model.predict(x)(0), expected, 1e-15);
}

TEST(TakagiSugeno, ReproducesStraightLinesOfEveryInputExactly) {
  const ArrayXd T = grid(-1.0, 1.0, 0.05);
  ArrayXXd x(T.size(), 2);
  x << T, (3.0 * T).cos();
  const ArrayXd y = 0.4 - 1.3 * x.col(0) + 0.7 * x.col(1);
  for (const int rules : {2, 3, 8}) {
    const TakagiSugeno model = fit_takagi_sugeno(x, y, rules);
    EXPECT_EQ(model.centres.size(), rules);
    EXPECT_EQ(model.width, 1.0 / (rules - 1));
    EXPECT_LT((model.predict(x) - y).abs().maxCoeff(), 1e-12) << rules;
  }
}

TEST(TakagiSugeno, ResidualIsOrthogonalToEveryTerm) {
  const ArrayXd x = grid(-1.0, 1.0, 0.02), y = bias_curve(5.0 + 45.0 * x);
  const TakagiSugeno model = fit_takagi_sugeno(x, y, 4);
  const ArrayXd residual = y - model.predict(x);
  EXPECT_GT(residual.abs().maxCoeff(), 1e-3);
  for (Eigen::Index rule = 0; rule < 4; ++rule)
    for (Eigen::Index term = 0; term < 2; ++term) {
      TakagiSugeno one = model;
      one.consequents.setZero();
      one.consequents(rule, term) = 1.0;
      EXPECT_NEAR((residual * one.predict(x)).sum(), 0.0, 1e-11);
    }
}

TEST(TakagiSugeno, MoreRulesFollowTheCurveMoreClosely) {
  const ArrayXd x = grid(-1.0, 1.0, 0.01), y = bias_curve(5.0 + 45.0 * x);
  double before = HUGE_VAL;
  for (const int rules : {2, 4, 8, 16}) {
    const ArrayXd r = y - fit_takagi_sugeno(x, y, rules).predict(x);
    const double rms = std::sqrt(r.square().mean());
    EXPECT_LT(rms, 0.6 * before) << rules;
    before = rms;
  }
  EXPECT_LT(before, 0.01);
}

TEST(TakagiSugeno, ARuleWithoutDataStaysFiniteAndSmall) {
  // Nothing between -0.6 and 0.6, where 5 of 9 centres lie.
  ArrayXd x(40);
  x << ArrayXd::LinSpaced(20, -1.0, -0.6), ArrayXd::LinSpaced(20, 0.6, 1.0);
  const ArrayXd y = 2.0 + 0.5 * x;
  const TakagiSugeno model = fit_takagi_sugeno(x, y, 9);
  EXPECT_TRUE(model.consequents.allFinite());
  EXPECT_LT((model.predict(x) - y).abs().maxCoeff(), 1e-9);
  EXPECT_LT(model.predict(grid(-1.0, 1.0, 0.01)).abs().maxCoeff(), 5.0);
}

TEST(TakagiSugeno, FarFromAllRulesTheNearestAnswers) {
  const ArrayXd x = grid(-1.0, 1.0, 0.1), y = x.square();
  const TakagiSugeno model = fit_takagi_sugeno(x, y, 3);
  ArrayXd far(1);
  far << 100.0;
  EXPECT_NEAR(model.predict(far)(0),
              model.consequents(2, 0) + 100.0 * model.consequents(2, 1), 1e-9);
}

TEST(TakagiSugeno, NeedsTwoRulesAndARow) {
  const ArrayXd x = grid(-1.0, 1.0, 0.5);
  EXPECT_TRUE(holds(rejection([&] { fit_takagi_sugeno(x, x, 1); }), "1 rules"));
  EXPECT_THROW(fit_takagi_sugeno(ArrayXd(), ArrayXd(), 4),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::takagi_sugeno_test
