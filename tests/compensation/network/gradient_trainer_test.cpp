// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "compensation/network/network_training.h"
#include "random/random_stream.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/sample_compensators.h"

namespace beamgyro::internal::gradient_trainer_test {
namespace {

using Eigen::ArrayXd;

// y = 0.5 x - 0.2 on a network without hidden layer: a quadratic error.
ScaledRows straight_line() {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(5, -1.0, 1.0);
  rows.target = 0.5 * rows.inputs.col(0) - 0.2;
  return rows;
}

RandomStream sample_order() {
  return RandomStream(1, 0, 0, kSampleOrderStream);
}

TEST(AdaptiveRate, KeepsAndDiscardsByThePapersThreeRules) {
  AdaptiveRate adaptive{0.1};
  EXPECT_TRUE(adaptive.keep_step(1.0, 0.9));  // fell
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05);
  EXPECT_TRUE(adaptive.keep_step(1.0, 1.04));  // rose by less than 1.05
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05);
  EXPECT_TRUE(adaptive.keep_step(1.0, 1.05));  // the border is not more
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05);
  EXPECT_TRUE(adaptive.keep_step(1.0, 1.0));  // did not fall
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05);
  EXPECT_FALSE(adaptive.keep_step(1.0, 1.06));
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05 * 0.70);
  EXPECT_FALSE(adaptive.keep_step(1.0, std::nan("")));
  EXPECT_DOUBLE_EQ(adaptive.rate, 0.1 * 1.05 * 0.70 * 0.70);
}

// From w = 0 on rows with mean(x^2) = 1/2: gradient of mean(e^2)/2 is
// (-0.25, 0.2), so one step of rate eta is eta (0.25, -0.2).
TEST(GradientAdaptive, FirstStepFollowsTheMeanGradient) {
  BpNetwork network({1, 1});
  const TrainOptions options{.max_epochs = 1, .learning_rate = 0.3};
  train_gradient_adaptive(straight_line(), {}, options, network);
  EXPECT_NEAR(network.weights()(0), 0.3 * 0.25, 1e-15);
  EXPECT_NEAR(network.weights()(1), -0.3 * 0.2, 1e-15);
}

TEST(GradientAdaptive, SecondStepCarriesTheMomentum) {
  BpNetwork network({1, 1});
  const TrainOptions options{
      .max_epochs = 2, .learning_rate = 0.1, .momentum = 0.9};
  train_gradient_adaptive(straight_line(), {}, options, network);
  // The error fell in step 1, so step 2 has the rate 0.105; the two weights
  // do not mix: gradients are (w0 - 0.5) / 2 and w1 + 0.2.
  const double first = 0.1 * 0.25;
  EXPECT_NEAR(network.weights()(0),
              first + 0.9 * first + 0.105 * 0.5 * (0.5 - first), 1e-15);
}

TEST(GradientAdaptive, HugeRateIsDiscardedUntilTheErrorFalls) {
  BpNetwork network({1, 1});
  const TrainOptions options{
      .max_epochs = 2000, .goal = 1e-6, .learning_rate = 1e6};
  const TrainSummary summary =
      train_gradient_adaptive(straight_line(), {}, options, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGoalReached);
  EXPECT_LE(summary.in_sample_rms, 1e-6);
  EXPECT_NEAR(network.weights()(0), 0.5, 1e-5);
}

TEST(Incremental, ChangesTheWeightsAfterEverySample) {
  ScaledRows one;
  one.inputs = ArrayXd::Constant(1, 0.5);
  one.target = ArrayXd::Constant(1, 1.0);
  BpNetwork network({1, 1});
  const TrainOptions options{
      .max_epochs = 2, .learning_rate = 0.1, .momentum = 0.5};
  RandomStream order = sample_order();
  train_incremental(one, {}, options, order, network);
  const double w1 = 0.1 * 0.5, b1 = 0.1;  // from e = -1
  const double e = 0.5 * w1 + b1 - 1.0;
  EXPECT_NEAR(network.weights()(0), w1 + 0.5 * w1 - 0.1 * e * 0.5, 1e-15);
  EXPECT_NEAR(network.weights()(1), b1 + 0.5 * b1 - 0.1 * e, 1e-15);
}

TEST(Incremental, StopsAtTheGoalOverTheWholeSet) {
  BpNetwork network({1, 1});
  const TrainOptions options{.max_epochs = 5000, .goal = 1e-4};
  RandomStream order = sample_order();
  const TrainSummary summary =
      train_incremental(straight_line(), {}, options, order, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGoalReached);
  EXPECT_LE(rms_error(network, straight_line()), 1e-4);
}

TEST(Incremental, OrderOfTheSamplesComesFromItsStream) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 5.0), 0.0, 1);
  const auto trained = [&](std::uint64_t seed) {
    RandomStream order(seed, 0, 0, kSampleOrderStream);
    BpNetwork network = random_network({1, 6, 1}, 1);
    const TrainOptions options{.max_epochs = 20};
    train_incremental(rows, {}, options, order, network);
    return network.weights();
  };
  EXPECT_EQ(trained(5), trained(5));
  EXPECT_NE(trained(5), trained(6));
}

TEST(Incremental, DivergenceIsAnErrorThatNamesTheLearningRate) {
  BpNetwork network({1, 1});
  const TrainOptions options{.max_epochs = 5000, .learning_rate = 50.0};
  RandomStream order = sample_order();
  EXPECT_THROW(train_incremental(straight_line(), {}, options, order, network),
               std::runtime_error);
}

TEST(GradientTrainers, BothLearnTheBiasCurveFarBetterThanACubic) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.0, 1);
  const ScaledRows held_out = curve_rows(grid(-38.75, 48.75, 2.5), 0.0, 2);
  for (const Trainer trainer :
       {Trainer::kIncremental, Trainer::kGradientAdaptive}) {
    const TrainOptions options{
        .trainer = trainer, .max_epochs = 4000, .patience = kGradientPatience};
    RandomStream order = sample_order();
    BpNetwork network = random_network({1, 6, 1}, 1);
    const TrainSummary summary =
        train_network(rows, held_out, options, order, network);
    EXPECT_LT(kCurveUnit * *summary.held_out_rms, 0.1)
        << static_cast<int>(trainer);  // [deg/s]; the cubic leaves 0.4
    EXPECT_EQ(*summary.held_out_rms, rms_error(network, held_out));
  }
}

}  // namespace
}  // namespace beamgyro::internal::gradient_trainer_test
