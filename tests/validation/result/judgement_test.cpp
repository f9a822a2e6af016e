// SPDX-License-Identifier: MIT
#include "validation/result/judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "statistics/intervals.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"
#include "validation/result/result_json.h"

namespace beamgyro::internal::judgement_test {
namespace {

DecidedLimit decided(const char* metric, Verdict result) {
  DecidedLimit one;
  one.limit.metric = metric;
  one.limit.most = 1.0;
  one.decision.result = result;
  return one;
}

CheckResult check(const char* name, CheckOutcome outcome) {
  return {.name = name, .outcome = outcome, .words = "Words."};
}

using enum Verdict;
constexpr CheckOutcome kPassed = CheckOutcome::kPassed;
constexpr CheckOutcome kNotTested = CheckOutcome::kNotTested;

ValidationResult decide_between(std::vector<DecidedLimit> limits,
                                std::vector<CheckResult> checks,
                                bool may_leave_untested = false) {
  SpecificationFile specification;
  specification.may_leave_untested = may_leave_untested;
  ValidationResult result;
  result.limits = std::move(limits);
  result.checks = std::move(checks);
  decide_on(specification, result);
  return result;
}

TEST(DecideOn, OneFailureOutweighsEverythingElse) {
  const ValidationResult of_limit =
      decide_between({decided("a", kPass), decided("b", kUndecided),
                      decided("c", kFail), decided("c", kFail)},
                     {check("jacobian", kPassed)});
  EXPECT_EQ(of_limit.verdict, kFail);
  EXPECT_EQ(of_limit.words, "Not met: c.");
  const ValidationResult of_check =
      decide_between({decided("a", kPass)},
                     {check("jacobian", kNotTested),
                      check("injection", CheckOutcome::kFailed)},
                     true);
  EXPECT_EQ(of_check.verdict, kFail);
  EXPECT_EQ(of_check.words, "Not met: injection. Words.");
  EXPECT_EQ(of_check.next, definition_of(of_check.checks[1]).mend);
}

TEST(DecideOn, WhatIsNotTestedDecidesWhereItIsAskedFor) {
  const std::vector<CheckResult> untested{check("jacobian", kNotTested),
                                          check("injection", kPassed),
                                          check("hold_out", kNotTested)};
  const ValidationResult strict = decide_between({}, untested);
  EXPECT_EQ(strict.verdict, kUndecided);
  EXPECT_EQ(strict.words, "No run could decide on jacobian.");
  const ValidationResult plain = decide_between({}, untested, true);
  EXPECT_EQ(plain.verdict, kPass);
  EXPECT_TRUE(holds(plain.words, "2 not tested (jacobian, hold_out)"));
  EXPECT_EQ(decide_between({decided("a", kUndecided)}, {}, true).verdict,
            kUndecided);
}

TEST(DecideOn, RatesMustBeSeenToComeOut) {
  const auto verdict = [](CheckOutcome injection, CheckOutcome true_rate) {
    return decide_between(
               {},
               {check("injection", injection), check("true_rate", true_rate)},
               true)
        .verdict;
  };
  EXPECT_EQ(verdict(kNotTested, kNotTested), kUndecided);
  EXPECT_EQ(verdict(kNotTested, kPassed), kPass);
  EXPECT_EQ(verdict(kPassed, kNotTested), kPass);
}

TEST(DecideOn, WhatHasToBeBetterAndIsNotFails) {
  ValidationResult result;
  result.comparisons = {
      {"before", {.rms = 1.0, .other_rms = 3.0, .gain = 8.0}, true},
      {"constant", {.rms = 1.0, .other_rms = 0.5}, true},
      {"cubic", {.rms = 1.0, .other_rms = 0.2}}};
  decide_on(default_specification(), result);
  EXPECT_EQ(result.verdict, kFail);
  EXPECT_EQ(result.words,
            "Of no use on these runs: with a constant trained on the same data "
            "0.5 deg/s rms are left, with the compensator 1.");
  result.comparisons[1].found = {
      .rms = 0.4, .other_rms = 0.5, .gain = 0.1, .half_width = 1.0};
  decide_on(default_specification(), result);
  EXPECT_TRUE(result.words.ends_with(
      "with the compensator 0.4, a difference within its 95 % interval."));
  result.comparisons.erase(result.comparisons.begin() + 1);
  decide_on(default_specification(), result);
  EXPECT_EQ(result.verdict, kPass);
  EXPECT_TRUE(
      result.words.starts_with("No better than a simple method: with a "
                               "cubic trained on the same data 0.2 deg/s"));
}

// Squares 9 and 1 of the other, 1 and 1 of the rate, one block to a cluster:
// the quotient of the sums is 5, and the shares of the clusters in them differ
// by 0.4 each, so the standard error of its logarithm is sqrt(2 (2 0.4^2)).
TEST(PairedResidual, IsAPairedTestOfTheQuotient) {
  const LeftDrift own{{1.0, -1.0}, {0, 1}}, other{{3.0, 1.0}, {0, 1}};
  const PairedResidual found = *paired_residual(own, other);
  EXPECT_NEAR(found.rms, 1.0, 1e-15);
  EXPECT_NEAR(found.other_rms, std::sqrt(5.0), 1e-15);
  EXPECT_NEAR(found.gain, std::log(5.0), 1e-14);
  EXPECT_NEAR(found.half_width, 0.8 * student_half_width(1.0), 1e-12);
  EXPECT_FALSE(found.is_better());
  const PairedResidual one_block = *paired_residual({{1.0}, {0}}, {{3.0}, {0}});
  EXPECT_TRUE(std::isinf(one_block.half_width));
  EXPECT_FALSE(one_block.is_better());
  EXPECT_FALSE(paired_residual({}, {}));
  EXPECT_FALSE(paired_residual({{std::nan("")}, {0}}, {{1.0}, {0}}));
  EXPECT_EQ(without_mean(other).means, (std::vector<double>{1.0, -1.0}));
}

TEST(DecideOn, WhatDoesNothingFailsWhateverItsLimits) {
  ValidationResult result;
  result.limits = {decided("a", kPass)};
  result.no_effect = "It does nothing.";
  decide_on({}, result);
  EXPECT_EQ(result.verdict, kFail);
  EXPECT_EQ(result.words, "It does nothing.");
}

TEST(DecidedLimits, SayWhatTheRecordedRateMeets) {
  SpecificationFile specification;
  const std::string name(metrics()[0].name);
  specification.limits = {
      {.metric = name, .most = 3.0},
      {.metric = name, .most = 1.0},
      {.metric = name, .most = 1.5, .relative_to = "before"},
      {.metric = name, .most = 1.5, .relative_to = "cubic"}};
  const MetricResult found{
      &metrics()[0], Estimate{2.0}, Estimate{0.5}, {{"cubic", Estimate{4.0}}}};
  std::vector<bool> met;
  for (const auto& [limit, decision] : decided_limits(specification, {found})) {
    EXPECT_EQ(decision.result, kPass);
    met.push_back(decision.met_before);
  }
  EXPECT_EQ(met, (std::vector<bool>{true, false, false, true}));
}

// A drift of 0.1 deg/s/K, of which the compensator leaves a tenth.
TEST(ComparisonsOf, TheConstantOfTheRunsNeedsTenKelvin) {
  const auto names = [](double kelvin) {
    RecordedRun made{.duration = 3600.0, .step = 1.0};
    made.temperature = [=](double t) { return kelvin * t / 3600.0; };
    made.bias = [T = made.temperature](double t) { return 2.0 + 0.1 * T(t); };
    DeviceEvidence found;
    found.runs = {made.recording()};
    const auto rate_with = [&](double share) {
      std::vector<double> rate;
      for (const double t : found.runs[0].time)
        rate.push_back(share * made.bias(t));
      return Evidence{{{"run", RunPurpose::kSoak, &found.runs[0], rate}},
                      150.0};
    };
    found.before = rate_with(1.0);
    found.after = rate_with(0.1);
    found.baselines = {{"none", found.before}, {"cubic", rate_with(0.1)}};
    std::string text;
    for (const ResidualComparison& one :
         comparisons_of(default_specification(), found))
      text += one.with + (one.is_required ? "!" : "") +
              (one.is_same ? "=" : "") + (one.found.is_better() ? "> " : " ");
    return text;
  };
  EXPECT_EQ(names(30.0), "before!> cubic= constant_of_runs!> ");
  EXPECT_EQ(names(9.0), "before!> cubic= ");
}

// JSON knows no NaN; a limit is in the unit of its metric or there is none.
TEST(ResultJson, SaysNullForWhatIsNotThere) {
  ValidationResult result;
  const Metric& metric = metrics()[0];
  const double none = std::nan("");
  result.metrics = {{&metric, Estimate{none}, {}, {}}};
  DecidedLimit relative = decided("x", kPass);
  relative.limit.metric = metric.name;
  relative.limit.relative_to = "cubic";
  result.limits = {relative};
  result.checks = {check("jacobian", kNotTested)};
  const nlohmann::ordered_json json = to_json(result);
  EXPECT_TRUE(json["metrics"][0]["before"]["value"].is_null());
  EXPECT_TRUE(json["metrics"][0]["after"].is_null());
  EXPECT_TRUE(json["metrics"][0]["limit"].is_null());
  EXPECT_EQ(json["metrics"][0]["result"], "pass");
  EXPECT_TRUE(json["checks"][0]["passed"].is_null());
  EXPECT_EQ(json["limits"][0]["relative_to"], "cubic");
}

}  // namespace
}  // namespace beamgyro::internal::judgement_test
