// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compensation/methods/bias_model.h"
#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::fit_test {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;

const std::vector<Input> kTemperature{parse_input("temperature")};
const std::vector<Input> kBoth{parse_input("temperature"),
                               parse_input("temperature_rate(60)")};

TrainingRows rows_of(const ArrayXXd& inputs, const ArrayXd& bias) {
  TrainingRows rows;
  rows.inputs = inputs;
  rows.temperature = inputs.col(0);
  rows.bias = bias;
  rows.range = {rows.temperature.minCoeff(), rows.temperature.maxCoeff()};
  return rows;
}

TrainingRows curve(double low = -40.0, double high = 50.0, double step = 2.5) {
  const ArrayXd T = grid(low, high, step);
  return rows_of(T, bias_curve(T));
}

Fit fit(const FitSpec& kind, const TrainingRows& rows,
        const TrainingRows& held_out = {},
        const std::vector<Input>& inputs = kTemperature) {
  return fit_model(kind, inputs, rows, held_out, 1);
}

TEST(Fit, NoneTakesNothingAndAConstantTakesTheMean) {
  const TrainingRows rows = curve();
  const Fit none = fit(NoneSpec{}, rows), constant = fit(ConstantSpec{}, rows);
  EXPECT_TRUE((none.model.predict(rows.inputs) == 0.0).all());
  EXPECT_EQ(std::get<ConstantBias>(constant.model.function).value,
            rows.bias.mean());
  EXPECT_TRUE((constant.model.predict(rows.inputs) == rows.bias.mean()).all());
  // E(b^2) = var(b) + mean(b)^2
  EXPECT_NEAR(std::pow(none.summary().in_sample_rms, 2),
              std::pow(constant.summary().in_sample_rms, 2) +
                  std::pow(rows.bias.mean(), 2),
              1e-12);
}

TEST(Fit, ScoresHeldOutRowsWithoutFittingThem) {
  const TrainingRows rows = curve(-40.0, 0.0), unseen = curve(0.0, 50.0);
  for (const FitSpec& kind :
       {FitSpec{ConstantSpec{}}, FitSpec{PolynomialSpec{2}},
        FitSpec{TableSpec{5.0}}, FitSpec{SplineSpec{}},
        FitSpec{ThermistorSpec{}}, FitSpec{FuzzySpec{4}}}) {
    const Fit found = fit(kind, rows, unseen);
    EXPECT_EQ(found.restarts.size(), 1u);
    EXPECT_EQ(found.summary().stop_reason, StopReason::kLeastSquares);
    EXPECT_EQ(found.summary().in_sample_rms, rms_residual(found.model, rows));
    EXPECT_EQ(found.summary().held_out_rms, rms_residual(found.model, unseen));
    EXPECT_TRUE((fit(kind, rows).model.predict(unseen.inputs) ==
                 found.model.predict(unseen.inputs))
                    .all());
  }
}

TEST(Fit, StraightLineInAFurtherInputIsRecovered) {
  const ArrayXd T = grid(-40.0, 50.0, 1.0);
  ArrayXXd x(T.size(), 2);
  x << T, 0.02 * (0.3 * T).sin();  // [degC], [K/s]
  const ArrayXd b = 0.3 + 0.01 * T - 2e-6 * T.cube() + 5.0 * x.col(1);
  for (const bool normalised : {true, false}) {
    const Fit found =
        fit(PolynomialSpec{3, normalised}, rows_of(x, b), {}, kBoth);
    EXPECT_LT(found.summary().in_sample_rms, 1e-11);
    ArrayXXd at(2, 2);
    at << 10.0, 0.0, 10.0, 0.01;
    const ArrayXd y = found.model.predict(at);
    EXPECT_NEAR(y(1) - y(0), 0.05, 1e-11);
  }
}

TEST(Fit, ACubicIsTheSameWithAndWithoutNormalising) {
  for (const TrainingRows& rows :
       {curve(-40.0, 85.0, 1.0), curve(25.0, 45.0, 0.5), curve(60.0, 85.0)})
    EXPECT_LT((fit(PolynomialSpec{3, true}, rows).model.predict(rows.inputs) -
               fit(PolynomialSpec{3, false}, rows).model.predict(rows.inputs))
                  .abs()
                  .maxCoeff(),
              1e-9);
}

TEST(Fit, UnnormalisedCubicIsEquationOneInKelvinsAbout25) {
  const ArrayXd dT = grid(-40.0, 50.0, 5.0) - 25.0;
  const ArrayXd b = 0.5 - 0.02 * dT + 3e-4 * dT.square() - 2e-6 * dT.cube();
  const Fit found = fit(PolynomialSpec{3, false}, rows_of(dT + 25.0, b));
  EXPECT_EQ(found.model.input_scales[0], (Scale{25.0, 1.0}));
  const auto& c = std::get<Polynomial>(found.model.function).coefficients;
  EXPECT_NEAR(c[0], 0.5, 1e-11);
  EXPECT_NEAR(c[1], -0.02, 1e-12);
  EXPECT_NEAR(c[2], 3e-4, 1e-13);
  EXPECT_NEAR(c[3], -2e-6, 1e-15);
}

TEST(Fit, DegreeZeroIsTheMeanAlsoOfOneTemperature) {
  const ArrayXd T = ArrayXd::Constant(6, 25.0);
  const Fit found =
      fit(PolynomialSpec{0}, rows_of(T, ArrayXd::LinSpaced(6, 0.0, 1.0)));
  EXPECT_NEAR(found.model.predict(T)(0), 0.5, 1e-15);
}

TEST(Fit, TooFewTemperaturesForTheDegreeAreNamed) {
  const ArrayXd T = grid(20.0, 22.9, 0.1);
  const TrainingRows rows = rows_of(T, T);
  EXPECT_TRUE(holds(rejection([&] { fit(PolynomialSpec{3}, rows); }),
                    "between 20.00 and 22.90 degC in the training rows, 3 "
                    "values 1 K apart; a polynomial of degree 3 needs 4"));
  EXPECT_NO_THROW(fit(PolynomialSpec{2}, rows));
}

TEST(Fit, BaselineFallsToTheDegreeTheTemperaturesDetermine) {
  const auto degree = [](double span) {
    const ArrayXd T = grid(20.0, 20.0 + span, 0.1);
    return std::get<Polynomial>(fit_baseline(rows_of(T, T)).function)
               .coefficients.size() -
           1;
  };
  EXPECT_EQ(degree(0.5), 0u);
  EXPECT_EQ(degree(1.5), 1u);
  EXPECT_EQ(degree(2.5), 2u);
  EXPECT_EQ(degree(9.0), 3u);
}

BpSpec network(const std::vector<double>& decays) {
  BpSpec spec;
  spec.hidden = {6};
  spec.weight_decays = decays;
  spec.training.restarts = 2;
  spec.training.max_epochs = 100;
  return spec;
}

TEST(Fit, TheWeightDecayThatLeavesLeastIsKeptAndTold) {
  const TrainingRows rows = curve(-40.0, 50.0, 5.0),
                     unseen = curve(-37.5, 47.5);
  const std::vector<double> decays{1e-1, 0.0, 1e-2};
  const Fit found = fit(network(decays), rows, unseen);
  ASSERT_EQ(found.choices.size(), 4u);
  double best = HUGE_VAL;
  for (std::size_t k = 0; k < decays.size(); ++k) {
    const Fit alone = fit(network({decays[k]}), rows, unseen);
    EXPECT_TRUE(alone.choices.empty());
    best = std::min(best, *alone.summary().held_out_rms);
    EXPECT_EQ(found.choices[k],
              fmt::format("weight decay {:g}: rms in-sample {:.6f}, held-out "
                          "{:.6f} deg/s",
                          decays[k], alone.summary().in_sample_rms,
                          *alone.summary().held_out_rms));
  }
  EXPECT_EQ(found.choices[3], "kept weight decay 0");  // the others bend it
  EXPECT_EQ(*found.summary().held_out_rms, best);
  EXPECT_NEAR(rms_residual(found.model, unseen), best, 1e-12);
}

TEST(Fit, AnInputThatNeverVariesIsNamed) {
  ArrayXXd x(20, 2);
  x << ArrayXd::LinSpaced(20, 0.0, 40.0), ArrayXd::Zero(20);
  const TrainingRows rows = rows_of(x, x.col(0));
  for (const FitSpec& kind : {FitSpec{PolynomialSpec{3}}, FitSpec{FuzzySpec{3}},
                              FitSpec{network({0.0})}})
    EXPECT_TRUE(holds(rejection([&] { fit(kind, rows, rows, kBoth); }),
                      "input temperature_rate(60) is 0 in all 20"));
}

}  // namespace
}  // namespace beamgyro::internal::fit_test
