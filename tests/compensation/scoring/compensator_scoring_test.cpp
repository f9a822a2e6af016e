// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/scoring/validation.h"
#include "compensation/training/train.h"
#include "tests/compensation/injected_scale_factor.h"
#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::compensator_scoring_test {
namespace {

/// Bias that the temperature determines, not a cubic [deg/s].
double bias_of(double temperature) {
  return 2.0 * std::tanh((temperature + 15.0) / 20.0) + 0.01 * temperature;
}

/// A slow sweep of temperature at rest; on the bias that belongs to it lies a
/// wander of 0.3 deg/s rms that the temperature does not determine.
Recording at_rest(double phase) {
  const auto temperature = [phase](double t) {
    return 5.0 + 45.0 * std::sin(2.0 * std::numbers::pi * t / 7200.0 + phase);
  };
  const auto wander = [phase](double t) {
    return 0.3 * (std::sin(0.0131 * t + phase) + std::sin(0.0417 * t));
  };
  return RecordedRun{
      .duration = 14400.0,
      .step = 1.0,
      .bias = [=](double t) { return bias_of(temperature(t)) + wander(t); },
      .temperature = temperature}
      .recording();
}

/// Eleven rates, a minute each, after half an hour with power.
Recording table_at(double temperature, double full_scale) {
  const auto table = rate_table(full_scale, 11, 60.0);
  return RecordedRun{
      .duration = 2460.0,
      .step = 1.0,
      .true_rate =
          [=](double t) { return t < 1800.0 ? 0.0 : table(t - 1800.0); },
      .bias = [=](double) { return bias_of(temperature); },
      .temperature = [=](double) { return temperature; }}
      .recording();
}

Compensator trained(const std::vector<std::string>& inputs,
                    decltype(ModelSpec::kind) kind) {
  ModelSpec spec;
  for (const std::string& name : inputs) {
    spec.inputs.push_back(parse_input(name));
  }
  spec.rows.seconds = 30.0;
  spec.kind = std::move(kind);
  const std::vector<TrainingRun> runs{{"train", "a", at_rest(0.0)}};
  const std::vector<TrainingRun> held_out{{"held out", "b", at_rest(1.0)}};
  return train(spec, runs, held_out, 1).compensator;
}

BpSpec network(std::vector<int> hidden) {
  BpSpec spec;
  spec.hidden = std::move(hidden);
  spec.training.restarts = 1;
  spec.training.max_epochs = 200;
  return spec;
}

double replayed(const Compensator& compensator) {
  return *injected_scale_factor(
      [&](const Recording& run) { return compensated_rate(compensator, run); },
      at_rest(2.0));
}

Validation on_tables_and_at_rest(const Compensator& compensator) {
  const Recording rest = at_rest(2.0);
  const Recording small = table_at(12.0, 2.0);
  const Recording cold = table_at(-20.0, 120.0);
  const Recording hot = table_at(33.0, 120.0);
  return validate(
      compensator, "compensator",
      {{"rest", &rest}, {"small", &small}, {"cold", &cold}, {"hot", &hot}});
}

TEST(Verification, V44ANetworkOnTheOutputTrainedAtRestCancelsTheRate) {
  const Compensator eater = trained({"output", "temperature"}, network({6}));
  EXPECT_LT(std::abs(replayed(eater)), 0.05);

  const Validation found = on_tables_and_at_rest(eater);
  EXPECT_LT(std::abs(found.overall.small_rates->retained), 0.05);
  EXPECT_LT(std::abs(found.overall.replayed->worst.worse()->retained), 0.05);
  EXPECT_GT(found.overall.every_rate->retained, 0.5);
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
  EXPECT_FALSE(found.passed());

  // At rest its residual is the best of all, which is the trap.
  const Score& rest = found.runs[0];
  EXPECT_LT(rest.residual.rms, 0.1 * rest.baseline->rms);
}

TEST(Verification, V44BiasOnlyCompensatorsOfEachKindKeepTheRateToRounding) {
  const std::vector<Compensator> all{
      trained({"temperature"}, PolynomialSpec{3}),
      trained({"temperature"}, SplineSpec{}),
      trained(
          {"temperature", "temperature_lowpass(100)", "since_power_on(300)"},
          network({3, 4}))};
  for (const Compensator& compensator : all) {
    const std::string kind = kind_name(compensator.bias);
    EXPECT_LT(std::abs(replayed(compensator) - 1.0), 1e-12) << kind;
    const Validation found = on_tables_and_at_rest(compensator);
    EXPECT_EQ(verdict_text(found.verdict), "keeps the rate") << kind;
    EXPECT_TRUE(found.passed()) << kind;
  }
}

TEST(CompensatorScoring, ReplaysEveryRunAtRestOrNot) {
  const Validation found =
      on_tables_and_at_rest(trained({"temperature"}, PolynomialSpec{3}));
  for (const Score& run : found.runs)
    EXPECT_NEAR(run.replayed->worst.worse()->retained, 1.0, 1e-9) << run.run;
  EXPECT_FALSE(found.runs[0].every_rate);
}

TEST(CompensatorScoring, TheCubicIsAHundredPercentOfItself) {
  const Validation found =
      on_tables_and_at_rest(trained({"temperature"}, PolynomialSpec{3}));
  EXPECT_NEAR(*found.overall.percent_of_cubic, 100.0, 1e-9);
}

}  // namespace
}  // namespace beamgyro::internal::compensator_scoring_test
