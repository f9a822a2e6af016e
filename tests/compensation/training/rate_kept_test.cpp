// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compensation/training/cautions.h"
#include "compensation/training/train.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"

namespace beamgyro::internal::rate_kept_test {
namespace {

// A ramp at rest, or under rates that the bias has nothing to do with. What the
// temperature leaves open of the bias only the output can tell.
std::vector<TrainingRun> ramp(bool at_rest, const char* sha256, double start) {
  RecordedRun run{.duration = 3000.0, .step = 1.0};
  run.temperature = [=](double t) { return start + 0.03 * t; };
  run.bias = [=](double t) {
    return bias_curve(start + 0.03 * t) + 0.2 * std::sin(0.05 * t);
  };
  if (!at_rest) run.true_rate = rate_table(60.0, 7, 40.0);
  return {{"ramp.h5", sha256, run.recording()}};
}

FittedCompensator trained(const std::vector<const char*>& inputs,
                          const FitSpec& kind, bool at_rest = true) {
  ModelSpec spec{.kind = kind};
  for (const char* input : inputs) spec.inputs.push_back(parse_input(input));
  spec.rows.seconds = 10.0;
  return train(spec, ramp(at_rest, "training", -40.0),
               ramp(at_rest, "held out", -39.9), 1)
      .compensator;
}

BpSpec network(double rate_penalty = 0.0) {
  BpSpec bp;
  bp.hidden = {4};
  bp.training.restarts = 1;
  bp.training.rate_penalty = rate_penalty;
  return bp;
}

TEST(RateKept, NothingIsKnownOfCompensatorsThatDoNotSeeTheRate) {
  for (const NamedCompensator& each : one_of_each_kind()) {
    if (std::ranges::any_of(each.compensator.inputs, sees_the_rate)) continue;
    EXPECT_FALSE(rate_kept(each.compensator)) << each.name;
  }
}

TEST(RateKept, NothingIsLeftByANetworkThatSawTheOutputAtRestOnly) {
  for (const char* input : {"output", "rate"}) {
    const auto kept = rate_kept(trained({input, "temperature"}, network()));
    ASSERT_TRUE(kept) << input;
    EXPECT_NEAR(*kept, 0.0, 0.05) << input;
  }
}

// Its bias is not scaled: the volts of a rate come from the baseline's span,
// which smooths the curve's ends.
TEST(RateKept, NothingIsLeftByAStraightLineInTheOutputEither) {
  const auto kept =
      rate_kept(trained({"temperature", "output"}, PolynomialSpec{}));
  ASSERT_TRUE(kept);
  EXPECT_LT(std::abs(*kept), 0.3);
}

TEST(RateKept, ThePenaltyOnTheRateKeepsIt) {
  const auto kept =
      rate_kept(trained({"output", "temperature"}, network(100.0)));
  ASSERT_TRUE(kept);
  EXPECT_NEAR(*kept, 1.0, 0.02);
}

TEST(RateKept, TrainingOnRatesKeepsThem) {
  EXPECT_FALSE(rate_kept(trained({"output", "temperature"}, network(), false)));
  const auto kept =
      rate_kept(trained({"rate", "temperature"}, network(), false));
  ASSERT_TRUE(kept);
  EXPECT_NEAR(*kept, 1.0, 0.1);
}

}  // namespace
}  // namespace beamgyro::internal::rate_kept_test
