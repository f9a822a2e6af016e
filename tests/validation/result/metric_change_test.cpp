// SPDX-License-Identifier: MIT
#include "validation/result/metric_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/config/rejection.h"
#include "validation/result/earlier_result.h"

namespace beamgyro::internal::metric_change_test {
namespace {

Estimate within(double value, double half_width) {
  return {value, Interval{value - half_width, value + half_width}};
}

MetricChange change(const char* metric, const Estimate& own,
                    const Estimate& other) {
  return change_of(*find_metric(metric), own, other);
}

TEST(MetricChange, TheIntervalOfTheDifferenceIsThatOfIndependentValues) {
  const MetricChange found =
      change("residual_rms_deg_per_s", within(0.5, 0.03), within(0.4, 0.04));
  EXPECT_DOUBLE_EQ(found.difference.value, 0.1);
  EXPECT_DOUBLE_EQ(found.difference.interval->low, 0.1 - 0.05);
  EXPECT_DOUBLE_EQ(found.difference.interval->high, 0.1 + 0.05);
  EXPECT_EQ(found.change, Change::kWorse);
}

TEST(MetricChange, OnlyTheSidesTowardsEachOtherCount) {
  // The larger value reaches far up, the smaller one far down.
  const Estimate larger{0.5, Interval{0.49, 5.0}};
  const Estimate smaller{0.4, Interval{-5.0, 0.41}};
  EXPECT_EQ(change("residual_rms_deg_per_s", larger, smaller).change,
            Change::kWorse);
  EXPECT_EQ(change("residual_rms_deg_per_s", smaller, larger).change,
            Change::kBetter);
}

TEST(MetricChange, WithinTheIntervalItIsTheSame) {
  EXPECT_EQ(
      change("bias_deg_per_s", within(0.5, 0.08), within(0.4, 0.08)).change,
      Change::kSame);
}

TEST(MetricChange, WhatIsBetterDependsOnTheMetric) {
  const auto direction = [](const char* metric, double own, double other) {
    return change(metric, within(own, 1e-3), within(other, 1e-3)).change;
  };
  EXPECT_EQ(direction("bias_deg_per_s", -0.2, 0.1), Change::kWorse);
  EXPECT_EQ(direction("bias_deg_per_s", 0.1, -0.2), Change::kBetter);
  EXPECT_EQ(direction("scale_factor", 1.01, 0.9), Change::kBetter);
  EXPECT_EQ(direction("scale_factor_retained", 0.9, 0.99), Change::kWorse);
  EXPECT_EQ(direction("bandwidth_Hz", 20.0, 80.0), Change::kWorse);
  EXPECT_EQ(direction("sigma_coverage_90_soaks_percent", 100.0, 91.0),
            Change::kWorse);
}

TEST(MetricChange, WithoutAnyIntervalAnotherValueIsUnknown) {
  EXPECT_EQ(change("added_delay_s", {0.01}, {0.02}).change, Change::kUnknown);
  EXPECT_EQ(change("added_delay_s", {0.01}, {0.01}).change, Change::kSame);
  EXPECT_EQ(change("added_delay_s", {0.01}, within(0.02, 1e-3)).change,
            Change::kBetter);
  EXPECT_EQ(change("added_delay_s", {NAN}, within(0.02, 1e-3)).change,
            Change::kUnknown);
}

ValidationResult result_with(const Estimate& rms, Verdict limit) {
  ValidationResult result;
  result.verdict = Verdict::kPass;
  result.words = "It passes.";
  result.metrics.push_back(
      {.metric = find_metric("residual_rms_deg_per_s"), .after = rms});
  DecidedLimit decided;
  decided.limit.metric = "bias_deg_per_s";
  decided.decision.result = limit;
  result.limits.push_back(decided);
  result.checks.push_back(
      {.name = "hold_out", .outcome = CheckOutcome::kPassed});
  return result;
}

EarlierResult earlier_with(const Estimate& rms) {
  return {.name = "old.json",
          .verdict = "pass",
          .metrics = {{"residual_rms_deg_per_s", rms}},
          .passed = {{"bias_deg_per_s", true}, {"hold_out", true}},
          .files = {}};
}

TEST(EarlierResult, TheSameAndTheBetterLeaveTheVerdictAsItIs) {
  for (const double rms : {0.1, 0.05}) {
    ValidationResult result = result_with(within(rms, 0.001), Verdict::kPass);
    compare_with(earlier_with(within(0.1, 0.001)), result);
    EXPECT_EQ(result.verdict, Verdict::kPass);
    EXPECT_FALSE(result.earlier->is_worse());
  }
}

TEST(EarlierResult, AMetricThatIsWorseFails) {
  ValidationResult result = result_with(within(0.2, 0.001), Verdict::kPass);
  compare_with(earlier_with(within(0.1, 0.001)), result);
  EXPECT_EQ(result.verdict, Verdict::kFail);
  EXPECT_TRUE(result.words.starts_with(
      "Worse than old.json: residual_rms_deg_per_s is 0.2 [0.199, 0.201], was "
      "0.1 [0.099, 0.101]. It passes."))
      << result.words;
}

TEST(EarlierResult, WhatPassedAndDoesNotAnyMoreFails) {
  for (const Verdict now : {Verdict::kFail, Verdict::kUndecided}) {
    ValidationResult result = result_with(within(0.1, 0.001), now);
    compare_with(earlier_with(within(0.1, 0.001)), result);
    EXPECT_EQ(result.verdict, Verdict::kFail);
    EXPECT_EQ(result.earlier->lost, std::vector<std::string>{"bias_deg_per_s"});
  }
}

TEST(EarlierResult, OtherInputsAreWarnedOf) {
  ValidationResult result = result_with(within(0.1, 0.001), Verdict::kPass);
  result.provenance.files = {{"device", "a.toml", "12"},
                             {"compensator", "c.json", "56"}};
  EarlierResult earlier = earlier_with(within(0.1, 0.001));
  earlier.files = {{"device", "a.toml", "34"}, {"compensator", "d.json", "78"}};
  compare_with(earlier, result);
  EXPECT_EQ(result.earlier->other_inputs, std::vector<std::string>{"device"});
  EXPECT_EQ(result.warnings.size(), 1U);
}

TEST(EarlierResult, AFileThatIsNoResultIsRefused) {
  EXPECT_TRUE(
      holds(rejection([] { (void)parse_earlier_result("{}", "a/old.json"); }),
            "a/old.json: \"filetype\" is missing"));
  EXPECT_TRUE(holds(rejection([] {
                      (void)parse_earlier_result(
                          R"({"filetype": "beamgyro-compensator"})",
                          "old.json");
                    }),
                    "old.json: filetype: \"beamgyro-compensator\"; expected"));
  // Nothing would be worse than an empty one.
  EXPECT_TRUE(holds(rejection([] {
                      (void)parse_earlier_result(
                          R"({"filetype": "beamgyro-validation",
                              "verdict": "pass", "metrics": [], "limits": [],
                              "checks": [], "provenance": {"files": []}})",
                          "old.json");
                    }),
                    "old.json: has no metric, limit or check"));
}

}  // namespace
}  // namespace beamgyro::internal::metric_change_test
