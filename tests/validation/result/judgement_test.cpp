// SPDX-License-Identifier: MIT
#include "validation/result/judgement.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "validation/result/result_json.h"

namespace beamgyro::internal::judgement_test {
namespace {

DecidedLimit decided(const char* metric, Conformity result) {
  DecidedLimit one;
  one.limit.metric = metric;
  one.limit.most = 1.0;
  one.decision.result = result;
  return one;
}

CheckResult check(const char* name, CheckOutcome outcome) {
  CheckResult one;
  one.name = name;
  one.outcome = outcome;
  one.words = "Words.";
  return one;
}

}  // namespace

TEST(VerdictOf, OneFailureOutweighsEverythingElse) {
  const WordedVerdict verdict = verdict_of(
      {decided("a", Conformity::kPass), decided("b", Conformity::kUndecided),
       decided("c", Conformity::kFail)},
      {check("jacobian", CheckOutcome::kPassed)});
  EXPECT_EQ(verdict.verdict, Conformity::kFail);
  EXPECT_NE(verdict.words.find('c'), std::string::npos);
  EXPECT_EQ(verdict.words.find("b,"), std::string::npos);
}

TEST(VerdictOf, AFailedCheckFails) {
  const WordedVerdict verdict =
      verdict_of({decided("a", Conformity::kPass)},
                 {check("jacobian", CheckOutcome::kPassed),
                  check("injection", CheckOutcome::kFailed)});
  EXPECT_EQ(verdict.verdict, Conformity::kFail);
  EXPECT_NE(verdict.words.find("injection"), std::string::npos);
}

TEST(VerdictOf, WhatIsNotTestedIsUndecided) {
  EXPECT_EQ(verdict_of({decided("a", Conformity::kPass)},
                       {check("jacobian", CheckOutcome::kNotTested)})
                .verdict,
            Conformity::kUndecided);
  EXPECT_EQ(verdict_of({decided("a", Conformity::kUndecided)},
                       {check("jacobian", CheckOutcome::kPassed)})
                .verdict,
            Conformity::kUndecided);
  EXPECT_EQ(verdict_of({decided("a", Conformity::kPass)},
                       {check("jacobian", CheckOutcome::kPassed)})
                .verdict,
            Conformity::kPass);
}

TEST(VerdictOf, NamesNoCheckThatMayBeUntested) {
  const WordedVerdict verdict =
      verdict_of({decided("a", Conformity::kPass)},
                 {check("jacobian", CheckOutcome::kNotTested),
                  check("hold_out", CheckOutcome::kNotTested)});
  EXPECT_EQ(verdict.words, "The evidence does not tell: jacobian.");
}

TEST(VerdictOf, CountsAndNamesOnce) {
  EXPECT_EQ(verdict_of({decided("a", Conformity::kPass)},
                       {check("jacobian", CheckOutcome::kPassed),
                        check("hold_out", CheckOutcome::kNotTested)})
                .words,
            "The compensator passes: 1 limit met, 1 check passed.");
  EXPECT_EQ(verdict_of({decided("a", Conformity::kFail),
                        decided("a", Conformity::kFail)},
                       {})
                .words,
            "Not met: a.");
}

// JSON knows no NaN; a limit is in the unit of its metric or there is none.
TEST(ResultJson, SaysNullForWhatIsNotThere) {
  ValidationResult result;
  const Metric& metric = metrics()[0];
  const double none = std::nan("");
  result.metrics = {{&metric, Estimate{none}, {}, {}}};
  DecidedLimit relative = decided("x", Conformity::kPass);
  relative.limit.metric = metric.name;
  relative.limit.relative_to = "cubic";
  result.limits = {relative};
  result.checks = {check("jacobian", CheckOutcome::kNotTested)};
  const nlohmann::ordered_json json = to_json(result);
  EXPECT_TRUE(json["metrics"][0]["before"]["value"].is_null());
  EXPECT_TRUE(json["metrics"][0]["after"].is_null());
  EXPECT_TRUE(json["metrics"][0]["limit"].is_null());
  EXPECT_EQ(json["metrics"][0]["result"], "pass");
  EXPECT_TRUE(json["checks"][0]["passed"].is_null());
  EXPECT_EQ(json["limits"][0]["relative_to"], "cubic");
}

}  // namespace beamgyro::internal::judgement_test
