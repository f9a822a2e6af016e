// SPDX-License-Identifier: MIT
#include "validation/specification/own_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/config/rejection.h"
#include "validation/result/decided_limits.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal::own_metrics_test {
namespace {

const std::string kLimited = "name,unit,before,after,low,high\n";

OwnMetricTable table_of(const std::string& text) {
  return parse_own_metrics(text, "t.csv");
}

std::string refusal_of(const std::string& text) {
  return rejection([&] { table_of(text); });
}

SpecificationFile specification_of(const std::string& limits) {
  return parse_specification_file("name = \"s\"\n" + limits, "s.toml");
}

// What a limit decides on a metric with these values.
Decision decision_of(const std::string& limit, double before, double after) {
  const SpecificationFile file = specification_of(limit);
  return decided_limits(file, {}, {{"mine", "V", {before}, {after}}})
      .at(0)
      .decision;
}

TEST(OwnMetrics, RowsAreMetricsAndTheirBoundsAreLimits) {
  const OwnMetricTable table = table_of(
      kLimited + "climb,m,12.5,0.25,,1\nshare,,0.5,nan,0.9,\nfree,%,,3,,\n");
  const auto results = own_metric_results(table.metrics, {}, {});
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].name, "climb");
  EXPECT_EQ(results[0].unit, "m");
  EXPECT_EQ(results[0].before.value, 12.5);
  EXPECT_EQ(results[0].after.value, 0.25);
  EXPECT_FALSE(results[0].after.interval);
  EXPECT_EQ(results[1].unit, "1");
  EXPECT_TRUE(std::isnan(results[1].after.value));
  EXPECT_TRUE(std::isnan(results[2].before.value));
  ASSERT_EQ(table.limits.size(), 2u);
  EXPECT_EQ(table.limits[0].metric, "climb");
  EXPECT_EQ(table.limits[0].most, 1.0);
  EXPECT_FALSE(table.limits[0].least);
  EXPECT_EQ(table.limits[0].source, "t.csv");
  EXPECT_EQ(table.limits[0].place, "t.csv:2:1");
  EXPECT_TRUE(table.limits[0].is_own);
  EXPECT_EQ(table.limits[1].least, 0.9);
  EXPECT_TRUE(table_of("name,unit,before,after\na,s,1,2\n").limits.empty());
}

TEST(OwnMetrics, TheRecordedAndTheCompensatedRateAreEvaluated) {
  const OwnMetricSource scale{
      "scale", "deg/s", [](const Evidence& evidence, JudgedRate rate) {
        return evidence.full_scale * (rate == JudgedRate::kRecorded ? 1 : -1);
      }};
  const auto results =
      own_metric_results(std::span(&scale, 1), {{}, 10.0}, {{}, 20.0});
  EXPECT_EQ(results.at(0).before.value, 10.0);
  EXPECT_EQ(results.at(0).after.value, -20.0);
}

TEST(OwnMetrics, WhatIsWrongInATableHasItsPlace) {
  EXPECT_EQ(refusal_of(""),
            "t.csv:1:1: is empty; expected columns "
            "name,unit,before,after[,low,high]");
  EXPECT_NE(refusal_of("name,before,after\na,1,2\n").find("t.csv:1:1: columns"),
            std::string::npos);
  EXPECT_NE(refusal_of(kLimited).find("has no row"), std::string::npos);
  EXPECT_NE(refusal_of(kLimited + "a,s,1\n").find("t.csv:2:"),
            std::string::npos);
  EXPECT_EQ(refusal_of(kLimited + "a,s,1,2x,,\n"),
            "t.csv:2:7: '2x': not a number; expected one, or nothing");
  EXPECT_EQ(refusal_of(kLimited + "a,s,1,1e999,,\n"),
            "t.csv:2:7: '1e999': out of range; expected a number");
  EXPECT_EQ(refusal_of(kLimited + "a,s,1,2,3,2\n"),
            "t.csv:2:9: 3 is above high = 2; expected at most that");
  EXPECT_NE(refusal_of(kLimited + "a,s,1,2,,inf\n").find("t.csv:2:10: 'inf'"),
            std::string::npos);
  EXPECT_NE(refusal_of(kLimited + "a,s,1,2,,\na,s,1,2,,\n")
                .find("t.csv:3:1: a: stands there twice"),
            std::string::npos);
  for (const char* name : {"", "2a", "a-b", "own metric", "<b>"})
    EXPECT_NE(refusal_of(kLimited + name + ",s,1,2,,\n").find("t.csv:2:1: "),
              std::string::npos)
        << name;
  EXPECT_NE(refusal_of(kLimited + "scale_factor,s,1,2,,\n")
                .find("is the name of a metric of the program"),
            std::string::npos);
  EXPECT_NE(refusal_of(kLimited + "true_rate,s,1,2,,\n")
                .find("is the name of a check of the program"),
            std::string::npos);
  EXPECT_NE(refusal_of(kLimited + "a,\x01,1,2,,\n").find("unit '\\x01'"),
            std::string::npos);
}

TEST(OwnMetrics, ALimitIsDecidedByTheValueItself) {
  const std::string limit = "[limits.own.mine]\nmax = 2\nsource = \"s\"\n";
  const Decision met = decision_of(limit, 5.0, 2.0);
  EXPECT_EQ(met.result, Verdict::kPass);
  EXPECT_FALSE(met.met_before);
  EXPECT_EQ(met.guard_band, 0.0);
  EXPECT_EQ(met.words, "2 is at most 2 by 0; it has no interval");
  const Decision missed = decision_of(limit, 1.0, 2.5);
  EXPECT_EQ(missed.result, Verdict::kFail);
  EXPECT_TRUE(missed.met_before);
  EXPECT_EQ(missed.words,
            "2.5, must be at most 2: beyond by 0.5; it has no interval");
}

TEST(OwnMetrics, AValueThatIsNotFiniteIsUndecided) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double none : {double{NAN}, kInfinite, -kInfinite}) {
    const Decision open =
        decision_of("[limits.own.mine]\nmax = 2\nsource = \"s\"\n", 1.0, none);
    EXPECT_EQ(open.result, Verdict::kUndecided) << none;
    EXPECT_EQ(open.words, "has no finite value, must be at most 2");
  }
}

TEST(OwnMetrics, ALimitMayBeAShareOfTheRecordedRates) {
  const std::string limit =
      "[limits_relative_to.before.own.mine]\nmax = 0.5\nsource = \"s\"\n";
  EXPECT_EQ(decision_of(limit, -4.0, 1.0).compared->value, 0.25);
  EXPECT_EQ(decision_of(limit, -4.0, 1.0).result, Verdict::kPass);
  EXPECT_EQ(decision_of(limit, 4.0, 3.0).result, Verdict::kFail);
  EXPECT_EQ(decision_of(limit, 0.0, 3.0).result, Verdict::kUndecided);
}

TEST(OwnMetrics, ASpecificationNamesThemBelowOwn) {
  const SpecificationFile file = specification_of(
      "[limits.own]\nclimb = { max = 1, source = \"s\" }\n"
      "[limits]\nscale_factor = { max = 2, source = \"s\" }\n");
  ASSERT_EQ(file.limits.size(), 2u);
  for (const Limit& limit : file.limits)
    EXPECT_EQ(limit.is_own, limit.metric == "climb");
  const OwnMetricTable table =
      table_of("name,unit,before,after\nclimb_m,m,1,2\n");
  EXPECT_EQ(rejection([&] { require_own_metrics(file.limits, table.metrics); }),
            "s.toml:3:9: climb: no metric of your own has this name; did you "
            "mean 'climb_m'?");
  EXPECT_NE(rejection([&] {
              require_own_metrics(file.limits, {});
            }).find("expected one to be given"),
            std::string::npos);
  EXPECT_NE(rejection([] {
              specification_of(
                  "[limits.own]\nscale_factor = { max = 2, source = \"s\" }\n");
            }).find("is the name of a metric of the program"),
            std::string::npos);
  EXPECT_NE(rejection([] {
              specification_of(
                  "[limits_relative_to.cubic.own]\nclimb = { max = 2, source = "
                  "\"s\" }\n");
            }).find("no value of the cubic"),
            std::string::npos);
}

}  // namespace
}  // namespace beamgyro::internal::own_metrics_test
