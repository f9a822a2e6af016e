// SPDX-License-Identifier: MIT
#include "compensation/training/cautions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/methods/bias_model.h"
#include "random/random_stream.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::cautions_test {
namespace {

using Eigen::ArrayXd;
using Strings = std::vector<std::string>;

const std::vector<Input> kTemperature{parse_input("temperature")};

/// Rows of a temperature over a minute each and a bias of it.
TrainingRows rows_of(const ArrayXd& temperature, const ArrayXd& bias) {
  TrainingRows rows;
  rows.inputs = rows.temperature = temperature;
  rows.bias = bias;
  rows.range = {temperature.minCoeff(), temperature.maxCoeff()};
  rows.time =
      60.0 * ArrayXd::LinSpaced(bias.size(), 0.0, double(bias.size() - 1));
  rows.run = rows.cycle = rows.leg = Eigen::ArrayXi::Zero(bias.size());
  rows.beyond_range = ArrayXd::Zero(bias.size());
  return rows;
}

TrainingRows straight(const ArrayXd& temperature) {
  return rows_of(temperature, 0.5 + 0.01 * temperature);
}

Strings cautions_of(const TrainingRows& rows, const FitSpec& kind,
                    const TrainingRows& held_out = {}, double resolution = 0.0,
                    const std::vector<Input>& inputs = kTemperature) {
  const BiasModel model = fit_model(kind, inputs, rows, {}, 1).model;
  return cautions(
      {inputs, model, fit_baseline(rows), rows, held_out, resolution});
}

void expect_one(const Strings& found, const std::string& part) {
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(holds(found[0], part));
}

TEST(Cautions, SoundDataDrawNone) {
  EXPECT_EQ(cautions_of(straight(grid(-40.0, 50.0, 1.0)), PolynomialSpec{1}),
            Strings{});
}

TEST(Cautions, TheDriveFrequencyOfADeviceThatAges) {
  TrainingRows rows = straight(grid(-40.0, 50.0, 1.0));
  rows.inputs = Eigen::ArrayXXd(rows.size(), 2);
  rows.inputs.col(0) = rows.temperature;
  rows.inputs.col(1) =
      9000.0 - 0.1 * rows.temperature + 1e-3 * rows.temperature.square();
  const std::vector<Input> inputs{parse_input("temperature"),
                                  parse_input("drive_frequency")};
  const BiasModel model =
      fit_model(PolynomialSpec{1}, inputs, rows, {}, 1).model;
  const auto found = [&](bool is_ageing) {
    return cautions(
        {inputs, model, fit_baseline(rows), rows, {}, 0.0, false, is_ageing});
  };
  EXPECT_EQ(found(false), Strings{});
  expect_one(found(true),
             "the input \"drive_frequency\" is no thermometer of a device with "
             "[memory] or [age]");
}

TEST(Cautions, SpanUnderTenKelvins) {
  EXPECT_EQ(cautions_of(straight(grid(20.0, 30.0, 1.0)), PolynomialSpec{1}),
            Strings{});
  expect_one(cautions_of(straight(grid(20.0, 29.5, 0.5)), PolynomialSpec{1}),
             "the temperature spans 9.5 K in training, less than 10 K: what is "
             "fitted holds from 20.0 to 29.5 degC only");
}

TEST(Cautions, GapInTheTemperatures) {
  EXPECT_EQ(cautions_of(straight(grid(-40.0, 50.0, 10.0)), PolynomialSpec{1}),
            Strings{});
  ArrayXd T(20);
  T << grid(40.0, 49.0, 1.0), grid(19.0, 28.0, 1.0);
  expect_one(cautions_of(straight(T), PolynomialSpec{1}),
             "no training row lies between 28.0 and 40.0 degC");
}

TEST(Cautions, TemperatureTooCoarseForTheSlope) {
  // A slope of 0.01 deg/s/K in steps of 1 K is 2.9e-3 deg/s rms.
  RandomStream random(3, 0, 0, RandomPurpose{0});
  TrainingRows rows = straight(grid(-40.0, 50.0, 0.5));
  ArrayXd noise(rows.size());
  for (double& value : noise) value = random.normal();
  const auto with_noise = [&](double sigma) {
    TrainingRows noisy = rows;
    noisy.bias += sigma * noise;
    return noisy;
  };
  expect_one(cautions_of(with_noise(3e-3), PolynomialSpec{1}, {}, 1.0),
             "comes in steps of 1 K, which alone make 0.00289 deg/s rms");
  EXPECT_EQ(cautions_of(with_noise(9e-3), PolynomialSpec{1}, {}, 1.0),
            Strings{});
  EXPECT_EQ(cautions_of(with_noise(3e-3), PolynomialSpec{1}, {}, 0.1),
            Strings{});
}

TEST(Cautions, HeldOutTemperaturesOutsideTheTraining) {
  const auto recorded = [](double low, double K_per_s) {
    RecordedRun run{.duration = 1800.0, .step = 1.0};
    run.temperature = [=](double t) {
      return low + K_per_s * 60.0 * std::floor(t / 60.0);
    };
    return std::vector<TrainingRun>{{"run.h5", "", run.recording()}};
  };
  const TrainingRows rows =
      training_rows(source_of(recorded(10.0, 0.01)), kTemperature, {});
  const auto found = [&](const std::vector<TrainingRun>& held_out) {
    return cautions_of(
        rows, PolynomialSpec{1},
        training_rows(source_of(held_out), kTemperature, {}, rows.range));
  };
  // The same soaks, their ends among them, are not outside.
  EXPECT_EQ(found(recorded(10.0, 0.01)), Strings{});
  // 10 ... 27.4 degC against 9 ... 35.1: two rows below, nine above.
  expect_one(found(recorded(9.0, 0.015)),
             "11 of 30 held-out rows lie outside 10.0 to 27.4 degC");
}

/// Up and down again at 1 K per row: legs 0 and 1.
TrainingRows loop(double hysteresis, double noise, int rounds = 1) {
  const Eigen::Index leg = 91;
  ArrayXd T(2 * leg * rounds), b(T.size());
  Eigen::ArrayXi legs(T.size());
  RandomStream random(5, 0, 0, RandomPurpose{0});
  for (Eigen::Index k = 0; k < T.size(); ++k) {
    const Eigen::Index of_leg = k % leg;
    legs(k) = static_cast<int>(k / leg);
    const bool up = legs(k) % 2 == 0;
    // Other places within the bins on the way down.
    T(k) = up ? -40.0 + double(of_leg) : 50.3 - double(of_leg);
    b(k) =
        0.05 * T(k) + (up ? 0.5 : -0.5) * hysteresis + noise * random.normal();
  }
  TrainingRows rows = rows_of(T, b);
  rows.leg = legs;
  return rows;
}

TEST(Cautions, HysteresisIsTheDifferenceBetweenRisingAndFalling) {
  const TrainingRows rows = loop(0.2, 0.0);
  const auto found = hysteresis(rows, rows.bias - 0.05 * rows.temperature);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->difference, 0.2, 1e-13);
  EXPECT_LT(found->standard_error, 1e-7);
  expect_one(cautions_of(rows, PolynomialSpec{1}),
             "rising and falling temperature differ by up to 0.2");
  TrainingRows one_way = straight(grid(-40.0, 50.0, 1.0));
  EXPECT_FALSE(hysteresis(one_way, one_way.bias).has_value());
}

TEST(Cautions, NoiseIsNotTakenForHysteresis) {
  for (const int rounds : {1, 5})
    EXPECT_EQ(cautions_of(loop(0.0, 0.01, rounds), PolynomialSpec{1}),
              Strings{});
  // Two legs of noise as large as the hysteresis tell nothing, ten do.
  EXPECT_EQ(cautions_of(loop(0.02, 0.02, 1), PolynomialSpec{1}), Strings{});
  EXPECT_EQ(cautions_of(loop(0.04, 0.02, 20), PolynomialSpec{1}).size(), 1u);
}

TEST(Cautions, ANoisyPlateauHasNoDirection) {
  RandomStream random(6, 0, 0, RandomPurpose{0});
  TrainingRows rows = straight(grid(-40.0, 50.0, 0.5));
  for (double& T : rows.temperature) T = 25.0 + 0.01 * random.normal();
  EXPECT_FALSE(hysteresis(rows, rows.bias).has_value());
}

TEST(Cautions, ModelsThatTellDirectionsApartAreSpared) {
  TrainingRows rows = loop(0.2, 0.01);
  const std::vector<Input> both{parse_input("temperature"),
                                parse_input("temperature_rate(60)")};
  Eigen::ArrayXXd inputs(rows.size(), 2);
  RandomStream random(7, 0, 0, RandomPurpose{0});
  for (Eigen::Index k = 0; k < rows.size(); ++k)
    inputs.row(k) << rows.temperature(k), random.normal();
  rows.inputs = inputs;
  EXPECT_EQ(cautions_of(rows, PolynomialSpec{1}, {}, 0.0, both), Strings{});
}

TEST(Cautions, AnInputThatFeelsTheRateInATrainingAtRest) {
  const std::vector<Input> both{parse_input("temperature"),
                                parse_input("output")};
  TrainingRows rows = straight(grid(-40.0, 50.0, 1.0));
  Eigen::ArrayXXd inputs(rows.size(), 2);
  inputs << rows.temperature, 2.5 + 0.0125 * rows.bias.square();
  rows.inputs = inputs;
  rows.true_rate_span = 0.0;
  expect_one(cautions_of(rows, PolynomialSpec{1}, {}, 0.0, both),
             "the input \"output\" feels the rate and training was at rest");
  rows.true_rate_span = 20.0;
  EXPECT_EQ(cautions_of(rows, PolynomialSpec{1}, {}, 0.0, both), Strings{});
}

TEST(Cautions, ResolutionIsTheSmallestStepOfTheMeasuredTemperature) {
  RecordedRun run{.duration = 600.0, .step = 1.0};
  EXPECT_EQ(temperature_resolution(run.recording()), 0.0);
  run.temperature = [](double t) { return 0.25 * std::floor(0.03 * t); };
  run.powered = [](double t) { return t < 100.0 || t > 130.0; };
  EXPECT_EQ(temperature_resolution(run.recording()), 0.25);
  Recording none = run.recording();
  std::erase_if(none.columns,
                [](const Column& c) { return c.name == "temperature"; });
  EXPECT_EQ(temperature_resolution(none), 0.0);
}

GroupErrors errors(std::initializer_list<double> values) {
  GroupErrors result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

TEST(Cautions, AClaimNeedsAGainAboveItsStandardError) {
  const GroupErrors constant = errors({4.0, 4.4, 3.6});
  EXPECT_EQ(objection_to_claim(errors({1.0, 1.1, 0.9}), constant), "");
  EXPECT_TRUE(holds(objection_to_claim(constant, constant), "no improvement"));
  // Better on average by less than the groups scatter: gain 0.2 +- 0.92.
  EXPECT_TRUE(holds(objection_to_claim(errors({5.0, 2.4, 4.0}), constant),
                    "no improvement to claim: 1.949 deg/s rms on unseen "
                    "data, a constant 2"));
  EXPECT_TRUE(holds(objection_to_claim(errors({9.0, 9.0, 9.0}), constant),
                    "no improvement"));
  // Two groups are no evidence, one has no scatter to judge by.
  for (const GroupErrors& few : {errors({1.0}), errors({1.0, 1.0})})
    EXPECT_TRUE(
        holds(objection_to_claim(few, 4.0 * few), "fewer than 3 groups"));
  // Sure, but of no use: 0.05 % of the rms.
  EXPECT_TRUE(holds(objection_to_claim(0.999 * constant, constant),
                    "a useful gain is 10 %"));
  EXPECT_TRUE(
      holds(objection_to_claim({}, constant), "nothing about new data"));
}

}  // namespace
}  // namespace beamgyro::internal::cautions_test
