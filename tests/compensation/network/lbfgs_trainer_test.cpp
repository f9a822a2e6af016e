// SPDX-License-Identifier: MIT
#include "compensation/network/lbfgs_trainer.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "compensation/network/levenberg_marquardt.h"
#include "compensation/network/random_purposes.h"
#include "tests/compensation/bias_curve.h"

namespace beamgyro::lbfgs_trainer_test {
namespace {

using Eigen::ArrayXd;

BpNetwork random_network(const std::vector<int>& sizes, std::uint32_t run) {
  RandomStream random(21, 0, run, kInitialWeightsStream);
  BpNetwork network(sizes);
  network.randomise(random);
  return network;
}

TrainOptions options_of_lbfgs() {
  TrainOptions options;
  options.trainer = Trainer::kLbfgs;
  options.max_epochs = kLbfgsMaxEpochs;
  options.patience = kLbfgsPatience;
  return options;
}

TEST(Lbfgs, LinearProblemIsSolvedToTheNormalEquations) {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(30, -1.0, 1.0);
  rows.target = rows.inputs.col(0).square();
  BpNetwork network({1, 1});
  const TrainSummary summary =
      train_lbfgs(rows, {}, options_of_lbfgs(), network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGradientSmall);
  EXPECT_NEAR(network.weights()(0), 0.0, 1e-9);
  EXPECT_NEAR(network.weights()(1), rows.target.mean(), 1e-9);
}

TEST(Lbfgs, WeightDecayShrinksTheSlopeOfALine) {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(30, -1.0, 1.0);
  rows.target = rows.inputs.col(0);
  const double power = rows.target.square().mean(), decay = 0.1;
  TrainOptions options = options_of_lbfgs();
  options.weight_decay = decay;
  BpNetwork network({1, 1});
  train_lbfgs(rows, {}, options, network);
  EXPECT_NEAR(network.weights()(0), power / (power + decay), 1e-9);
}

// The decay makes the minimum a point: without it the error falls ever more
// slowly along weights that grow. Measured: 3e-4 of the rms apart at most,
// where the line search sees no fall any more.
TEST(Lbfgs, ReachesTheMinimumOfLevenbergMarquardt) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.01, 1);
  for (std::uint32_t run = 0; run < 4; ++run) {
    TrainOptions options = options_of_lbfgs();
    options.weight_decay = 1e-6;
    BpNetwork ours = random_network({1, 6, 1}, run), reference = ours;
    const TrainSummary a = train_lbfgs(rows, {}, options, ours);
    const TrainSummary b =
        train_levenberg_marquardt(rows, {}, options, reference);
    EXPECT_NEAR(a.in_sample_rms, b.in_sample_rms, 0.01 * b.in_sample_rms)
        << run;
  }
}

TEST(Lbfgs, StopsAtTheGoal) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.0, 1);
  TrainOptions options = options_of_lbfgs();
  options.goal = 0.02 / kCurveUnit;
  BpNetwork network = random_network({1, 6, 1}, 0);
  const TrainSummary summary = train_lbfgs(rows, {}, options, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGoalReached);
  EXPECT_LE(summary.in_sample_rms, options.goal);
}

TEST(Lbfgs, StopsAtTheLargestNumberOfEpochs) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.0, 1);
  TrainOptions options = options_of_lbfgs();
  options.max_epochs = 3;
  BpNetwork network = random_network({1, 6, 1}, 0);
  const TrainSummary summary = train_lbfgs(rows, {}, options, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kMaxEpochs);
  EXPECT_EQ(summary.epochs, 3);
}

TEST(Lbfgs, HeldOutErrorStopsItBeforeItLearnsTheNoise) {
  const double noise = 0.01;  // [deg/s]
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), noise, 1);
  const ScaledRows held_out = curve_rows(grid(-38.75, 48.75, 2.5), noise, 2);
  const TrainOptions options = options_of_lbfgs();
  BpNetwork stopped = random_network({1, 14, 1}, 0), overfitted = stopped;
  const TrainSummary early = train_lbfgs(rows, held_out, options, stopped);
  const TrainSummary late = train_lbfgs(rows, {}, options, overfitted);
  EXPECT_EQ(early.stop_reason, StopReason::kHeldOutRising);
  EXPECT_EQ(early.epochs - early.best_epoch, options.patience);
  EXPECT_EQ(*early.held_out_rms, rms_error(stopped, held_out));
  EXPECT_GT(early.in_sample_rms, late.in_sample_rms);
  EXPECT_LT(*early.held_out_rms, rms_error(overfitted, held_out));
}

TEST(Lbfgs, SameStartGivesTheSameBytesAndNothingOnStandardError) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.01, 1);
  BpNetwork a = random_network({1, 6, 1}, 2), b = a;
  testing::internal::CaptureStderr();
  train_lbfgs(rows, {}, options_of_lbfgs(), a);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  train_lbfgs(rows, {}, options_of_lbfgs(), b);
  EXPECT_EQ(a.weights(), b.weights());
}

// Targets whose squares overflow: no step has a finite error.
TEST(Lbfgs, ErrorThatIsNotFiniteIsAFailure) {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(5, -1.0, 1.0);
  rows.target = ArrayXd::Constant(5, 1e200);
  BpNetwork network({1, 1});
  EXPECT_THROW(train_lbfgs(rows, {}, options_of_lbfgs(), network),
               std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::lbfgs_trainer_test
