// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "compensation/network/network_training.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/sample_compensators.h"

namespace beamgyro::internal::levenberg_marquardt_test {
namespace {

using Eigen::ArrayXd;

TEST(LevenbergMarquardt, FindsANetworkThatMadeTheData) {
  const BpNetwork truth = random_network({2, 3, 1}, 21, 0);
  ScaledRows rows;
  rows.inputs = Eigen::ArrayXXd::NullaryExpr(200, 2, [](auto i, auto j) {
    return std::sin(0.7 * double(i) * double(j + 1));
  });
  rows.target = truth.predict(rows.inputs);
  const TrainOptions options{.restarts = 6, .max_epochs = 500};
  const Restarts found = train_from_restarts({2, 3, 1}, rows, {}, options, 4);
  EXPECT_LT(found.summaries[found.chosen].in_sample_rms, 1e-9);
}

TEST(LevenbergMarquardt, LinearProblemIsSolvedToTheNormalEquations) {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(30, -1.0, 1.0);
  rows.target = rows.inputs.col(0).square();
  BpNetwork network({1, 1});
  const TrainSummary summary = train_levenberg_marquardt(rows, {}, {}, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGradientSmall);
  EXPECT_NEAR(network.weights()(0), 0.0, 1e-9);
  EXPECT_NEAR(network.weights()(1), rows.target.mean(), 1e-9);
}

TEST(LevenbergMarquardt, WeightDecayShrinksTheSlopeOfALine) {
  ScaledRows rows;
  rows.inputs = ArrayXd::LinSpaced(30, -1.0, 1.0);
  rows.target = rows.inputs.col(0);
  const double power = rows.target.square().mean(), decay = 0.1;
  const TrainOptions options{.weight_decay = decay};
  BpNetwork network({1, 1});
  train_levenberg_marquardt(rows, {}, options, network);
  EXPECT_NEAR(network.weights()(0), power / (power + decay), 1e-9);
}

TEST(LevenbergMarquardt, StopsAtTheGoal) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.0, 1);
  const TrainOptions options{.goal = 0.01 / kCurveUnit};
  BpNetwork network = random_network({1, 6, 1}, 21, 0);
  const TrainSummary summary =
      train_levenberg_marquardt(rows, {}, options, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kGoalReached);
  EXPECT_LE(summary.in_sample_rms, options.goal);
  EXPECT_LT(summary.epochs, 100);
}

TEST(LevenbergMarquardt, StopsAtTheLargestNumberOfEpochs) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), 0.0, 1);
  const TrainOptions options{.max_epochs = 3};
  BpNetwork network = random_network({1, 6, 1}, 21, 0);
  const TrainSummary summary =
      train_levenberg_marquardt(rows, {}, options, network);
  EXPECT_EQ(summary.stop_reason, StopReason::kMaxEpochs);
  EXPECT_EQ(summary.epochs, 3);
}

// 37 points with noise of 0.005 deg/s and 43 weights. Measured over these four
// starts, against the curve without noise: 0.0027 ... 0.0029 deg/s when the
// held-out error stops it, 0.016 ... 0.44 deg/s when nothing does.
TEST(LevenbergMarquardt, HeldOutErrorStopsItBeforeItLearnsTheNoise) {
  const double noise = 0.005;  // [deg/s]
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 2.5), noise, 1);
  const ScaledRows held_out = curve_rows(grid(-38.75, 48.75, 2.5), noise, 2);
  const ScaledRows truth = curve_rows(grid(-40.0, 50.0, 0.1), 0.0, 3);
  const TrainOptions options{.max_epochs = 2000};
  for (std::uint32_t run = 0; run < 4; ++run) {
    BpNetwork stopped = random_network({1, 14, 1}, 21, run),
              overfitted = stopped;
    const TrainSummary early =
        train_levenberg_marquardt(rows, held_out, options, stopped);
    const TrainSummary late =
        train_levenberg_marquardt(rows, {}, options, overfitted);
    EXPECT_EQ(early.stop_reason, StopReason::kHeldOutRising);
    EXPECT_GE(early.epochs - early.best_epoch, options.patience);
    EXPECT_LT(*early.held_out_rms, rms_error(overfitted, held_out));
    EXPECT_GT(early.in_sample_rms, 3.0 * late.in_sample_rms);
    EXPECT_LT(kCurveUnit * rms_error(stopped, truth), 0.0035) << run;
    EXPECT_GT(kCurveUnit * rms_error(overfitted, truth), 0.010) << run;
  }
}

TEST(LevenbergMarquardt, ThreadsDoNotChangeABit) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 0.02), 0.005, 1);
  TrainOptions options{.max_epochs = 20};
  BpNetwork one = random_network({1, 6, 1}, 21, 0), three = one;
  train_levenberg_marquardt(rows, {}, options, one);
  options.threads = 3;
  train_levenberg_marquardt(rows, {}, options, three);
  EXPECT_EQ(one.weights(), three.weights());
}

TEST(Verification, V43NetworkOnA5KGridLeavesLessThanSixThousandths) {
  const double noise = 0.005;  // [deg/s]
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 5.0), noise, 1);
  const ScaledRows held_out = curve_rows(grid(-37.5, 47.5, 5.0), noise, 2);
  const ScaledRows truth = curve_rows(grid(-40.0, 50.0, 0.1), 0.0, 3);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Restarts found =
        train_from_restarts({1, 6, 1}, rows, held_out, {}, seed);
    EXPECT_LT(kCurveUnit * rms_error(found.network, truth), 0.006)
        << "seed " << seed;
  }
}

TEST(NoWorse, AsksForTwiceTheStandardErrorOfTheStretches) {
  // 20 stretches of 3 rows whose excess alternates between a and -b: mean
  // (a - b) / 2, standard error (a + b) / 2 / sqrt(19).
  const auto answer = [](double a, double b) {
    Eigen::ArrayXd excess(60);
    for (Eigen::Index k = 0; k < 60; ++k) excess(k) = k / 3 % 2 == 0 ? a : -b;
    const Eigen::ArrayXd least = Eigen::ArrayXd::Constant(60, 5.0);
    return no_worse(least + excess, least);
  };
  const double ratio = 2.0 / std::sqrt(19.0);  // (a - b) / (a + b) at the limit
  const double b = 1.0, a = (1.0 + ratio) / (1.0 - ratio);
  EXPECT_TRUE(answer(0.999 * a, b));
  EXPECT_FALSE(answer(1.001 * a, b));
  EXPECT_TRUE(answer(-1.0, 1.0));   // less everywhere
  EXPECT_FALSE(answer(0.1, -0.1));  // more everywhere
}

TEST(Restarts, WhereHeldOutRowsCannotTellAllRowsChoose) {
  const ScaledRows rows = curve_rows(grid(-40.0, 50.0, 5.0), 0.005, 1);
  const ScaledRows held_out = curve_rows(grid(-37.5, 47.5, 5.0), 0.005, 2);
  const TrainOptions options{.restarts = 7};
  const Restarts a = train_from_restarts({1, 6, 1}, rows, held_out, options, 9);
  const Restarts b = train_from_restarts({1, 6, 1}, rows, held_out, options, 9);
  EXPECT_EQ(a.network.weights(), b.network.weights());
  ASSERT_EQ(a.summaries.size(), 7u);
  // The chosen one's errors over both sets, of as many rows each but one.
  const auto both = [&](const TrainSummary& summary) {
    return 19 * std::pow(summary.in_sample_rms, 2) +
           18 * std::pow(*summary.held_out_rms, 2);
  };
  double lowest = HUGE_VAL;
  for (const TrainSummary& summary : a.summaries) {
    lowest = std::min(lowest, *summary.held_out_rms);
    if (*summary.held_out_rms <= *a.summaries[a.chosen].held_out_rms) {
      EXPECT_LE(both(a.summaries[a.chosen]), both(summary) * (1 + 1e-12));
    }
  }
  EXPECT_LT(*a.summaries[a.chosen].held_out_rms, 1.5 * lowest);
  for (std::size_t k = 1; k < 7; ++k)  // no two from the same weights
    EXPECT_NE(*a.summaries[k].held_out_rms, *a.summaries[0].held_out_rms);
  EXPECT_EQ(rms_error(a.network, held_out),
            *a.summaries[a.chosen].held_out_rms);
  const Restarts other =
      train_from_restarts({1, 6, 1}, rows, held_out, options, 10);
  EXPECT_NE(a.network.weights(), other.network.weights());
}

}  // namespace
}  // namespace beamgyro::internal::levenberg_marquardt_test
