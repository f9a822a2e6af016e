// SPDX-License-Identifier: MIT
#include "compensation/network/rate_penalty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

#include "compensation/scoring/scale_factor.h"
#include "compensation/training/train.h"
#include "random/random_stream.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/injected_scale_factor.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::rate_penalty_test {
namespace {

using Eigen::VectorXd;

BpNetwork random_network(const std::vector<int>& layers) {
  RandomStream random(5, 0, 0, kInitialWeightsStream);
  BpNetwork network(layers);
  network.randomise(random);
  return network;
}

// Two inputs over the unit square, output scaled like the bias.
ScaledRows some_rows(Eigen::Index count) {
  ScaledRows rows{Eigen::ArrayXXd(count, 2), Eigen::ArrayXd::Zero(count)};
  for (Eigen::Index k = 0; k < count; ++k)
    rows.inputs.row(k) << std::sin(0.7 * double(k)), std::cos(1.1 * double(k));
  return rows;
}

TrainOptions options(double penalty, const std::vector<double>& direction) {
  TrainOptions result;
  result.rate_penalty = penalty;
  result.rate_direction = direction;
  return result;
}

// A network without hidden layer, y = w_0 x_0 + w_1 x_1 + b, takes the share
// g = w . d of the rate at every step.
TEST(RatePenalty, OfAStraightLineIsTheSquareOfItsSlopeAlongTheRate) {
  const BpNetwork line({2, 1});
  RatePenalty penalty(line, some_rows(20), options(3.0, {0.5, -2.0}));
  const VectorXd w = (VectorXd(3) << 0.8, 0.3, 7.0).finished();
  const double g = 0.8 * 0.5 - 0.3 * 2.0;
  EXPECT_NEAR(penalty.value(w), 0.5 * 3.0 * g * g, 1e-12);
}

TEST(RatePenalty, WeighsWhatANetworkTakesOnTheWayToLargeRates) {
  // Flat within |x| < 3, one unit taken beyond.
  BpNetwork step({1, 1, 1});
  const VectorXd w = (VectorXd(4) << 20.0, -100.0, 0.5, 0.5).finished();
  ScaledRows rows{Eigen::ArrayXXd::Zero(7, 1), Eigen::ArrayXd::Zero(7)};
  RatePenalty penalty(step, rows, options(1.0, {1.0}));
  // Of the seven steps +10 and +100 cross x = 5.
  EXPECT_NEAR(penalty.value(w), 0.5 * (0.1 * 0.1 + 0.01 * 0.01) / 7.0, 1e-9);
}

TEST(RatePenalty, GradientIsThatOfCentralDifferences) {
  const BpNetwork network = random_network({2, 5, 3, 1});
  RatePenalty penalty(network, some_rows(60), options(2.5, {0.6, 0.2}));
  const VectorXd& w = network.weights();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(w.size(), w.size());
  VectorXd gradient = VectorXd::Zero(w.size());
  penalty.add_to(w, matrix, gradient);
  EXPECT_GT(gradient.norm(), 1e-3);
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    VectorXd up = w, down = w;
    up(i) += 1e-5;
    down(i) -= 1e-5;
    EXPECT_NEAR((penalty.value(up) - penalty.value(down)) / 2e-5, gradient(i),
                1e-6)
        << i;
  }
}

// In the last layer g is linear in the weights, so that Gauss-Newton is exact.
TEST(RatePenalty, MatrixIsTheSecondDerivativeWhereTheNetworkIsLinear) {
  const BpNetwork network = random_network({2, 4, 1});
  RatePenalty penalty(network, some_rows(30), options(0.7, {1.0, 0.3}));
  const VectorXd& w = network.weights();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(w.size(), w.size());
  VectorXd ignored = VectorXd::Zero(w.size());
  penalty.add_to(w, matrix, ignored);
  for (Eigen::Index i = 12; i < 16; ++i) {
    VectorXd up = w;
    up(i) += 1.0;
    Eigen::MatrixXd none = Eigen::MatrixXd::Zero(w.size(), w.size());
    VectorXd before = VectorXd::Zero(w.size()), after = before;
    penalty.add_to(w, none, before);
    penalty.add_to(up, none, after);
    for (Eigen::Index j = i; j < 16; ++j)
      EXPECT_NEAR(matrix(j, i), after(j) - before(j), 1e-12);
  }
}

TEST(RatePenalty, NoneIsZeroAndNeedsNoDirection) {
  const BpNetwork network = random_network({2, 4, 1});
  RatePenalty none(network, some_rows(9), TrainOptions{});
  EXPECT_FALSE(none.active());
  EXPECT_EQ(none.value(network.weights()), 0.0);
  EXPECT_TRUE(
      holds(rejection([&] {
              RatePenalty(network, some_rows(9), options(1.0, {0.0, 0.0}));
            }),
            "an input that changes with it"));
}

// Soaks at rest of a gyro whose bias the temperature leaves open by 0.1 deg/s
// rms: what a network on the output can get only by cancelling the rate.
Recording soaks(double first, double phase) {
  RecordedRun run{.duration = 120.0 * 18.0, .step = 1.0};
  run.temperature = [=](double t) {
    return first + 5.0 * std::floor(t / 120.0);
  };
  run.bias = [=](double t) {
    return bias_curve(run.temperature(t)) + 0.2 * std::sin(0.05 * t + phase);
  };
  // Without power at first, as a cold soak begins.
  run.powered = [](double t) { return t >= 30.0; };
  return run.recording();
}

TrainResult trained(double penalty, const char* input) {
  BpSpec bp;
  bp.hidden = {6};
  bp.training.rate_penalty = penalty;
  const ModelSpec spec{
      .inputs = {parse_input(input), parse_input("temperature")}, .kind = bp};
  return train(spec, {{"a.h5", "a", soaks(-40.0, 0.0)}},
               {{"b.h5", "b", soaks(-37.5, 1.0)}}, 1);
}

// What is kept of recorded rates and of rates that are added at rest.
struct Kept {
  double recorded, added;  // [-], what departs most from 1, and the least
};

Kept kept(const FittedCompensator& c) {
  RecordedRun turning{.duration = 2640.0, .step = 1.0};
  turning.temperature = [](double t) { return 10.0 + 0.005 * t; };
  turning.bias = [T = turning.temperature](double t) {
    return bias_curve(T(t));
  };
  const auto rate_of = [&c](const Recording& run) {
    return compensated_rate(c, run);
  };
  Kept found{1.0, 1.0};
  for (const auto& table :
       {rate_table(100.0, 11, 60.0), rate_table(2.0, 5, 60.0)}) {
    turning.true_rate = table;
    const Recording run = turning.recording();
    const double share = scale_factor(slope_sums(run, rate_of(run)))->retained;
    if (std::abs(share - 1.0) > std::abs(found.recorded - 1.0))
      found.recorded = share;
  }
  found.added = *injected_scale_factor(rate_of, soaks(-38.0, 2.0));
  return found;
}

TEST(RatePenalty, WithoutItANetworkOnTheOutputCancelsTheRate) {
  const TrainResult result = trained(0.0, "output");
  EXPECT_LT(result.summary().in_sample_rms, 0.02);
  EXPECT_LT(std::abs(kept(result.compensator).recorded), 0.3);
}

TEST(RatePenalty, WithItTheNetworkKeepsTheRateAndOwnsUpToTheResidual) {
  for (const char* input : {"output", "rate"}) {
    const TrainResult result = trained(100.0, input);
    EXPECT_GT(result.summary().in_sample_rms, 0.06);
    EXPECT_LT(result.summary().in_sample_rms, 0.13);
    const Kept found = kept(result.compensator);
    EXPECT_NEAR(found.recorded, 1.0, 1e-3) << input;
    EXPECT_NEAR(found.added, 1.0, 1e-3) << input;
  }
}

// Between the steps and the rows that the penalty looks at there is room to
// eat.
TEST(RatePenalty, AReplayFindsWhatATenthOfItLeavesOpen) {
  const Kept found = kept(trained(10.0, "output").compensator);
  EXPECT_NEAR(found.recorded, 1.0, 1e-3);
  EXPECT_LT(found.added, 0.9);
}

TEST(RatePenalty, ALargerOneLeavesMoreOfTheRate) {
  double before = HUGE_VAL;
  for (const double penalty : {0.01, 1.0, 100.0}) {
    const Kept found = kept(trained(penalty, "output").compensator);
    const double taken = std::abs(found.recorded - 1.0);
    EXPECT_LT(taken, before) << penalty;
    before = taken;
  }
}

}  // namespace
}  // namespace beamgyro::internal::rate_penalty_test
