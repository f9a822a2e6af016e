// SPDX-License-Identifier: MIT
#include "report/validation_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::validation_report_test {
namespace {

const Recording& table_run() {
  static const Recording run = RecordedRun{
      .duration = 660.0,
      .true_rate = rate_table(100.0, 11, 60.0),
      .bias = [](double t) {
        return t < 300.0 ? 1.0 : 3.0;
      }}.recording();
  return run;
}

Validation validated(const std::string& method, double left,
                     const std::string& run_name) {
  AnsweredRun answer{.name = run_name, .recording = &table_run()};
  const auto& rate = column_values(table_run(), "rate");
  const auto& truth = column_values(table_run(), "true_rate");
  for (std::size_t k = 0; k < rate.size(); ++k) {
    answer.compensated.push_back(truth[k] + left * (rate[k] - truth[k]));
  }
  answer.baseline = rate;
  return validate(method, {answer});
}

std::size_t lines_with(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(ValidationReport, JsonHoldsTheScoresWithTheirUnits) {
  const Validation validation = validated("half", 0.5, "table.h5");
  const auto json = to_json(validation);
  EXPECT_EQ(json["method"], "half");
  EXPECT_EQ(json["passed"], validation.passed());
  EXPECT_EQ(json["verdict"], validation.passed() ? "pass" : "fail");
  EXPECT_EQ(json["words"], verdict_text(validation.verdict));
  EXPECT_EQ(json["checks"].size(), 3U);
  const auto& run = json["runs"][0];
  EXPECT_EQ(run["run"], "table.h5");
  EXPECT_DOUBLE_EQ(run["residual"]["variance_deg2_per_s2"].get<double>(),
                   validation.runs[0].residual.variance);
  EXPECT_NEAR(run["percent_of_cubic"].get<double>(), 25.0, 1e-9);
  EXPECT_TRUE(run["scale_factor"]["within_2_deg_per_s"].is_null());
  EXPECT_NEAR(run["scale_factor"]["every_rate"]["retained"].get<double>(), 1.0,
              0.02);
  EXPECT_EQ(run["linearity"]["rates"], 11);
}

TEST(ValidationReport, JsonTextIsReadableWhereAFigureIsNotFinite) {
  const auto json = to_json(validated("none", std::nan(""), "table.h5"));
  const auto read = nlohmann::json::parse(json.dump());
  EXPECT_TRUE(read["overall"]["residual"]["rms_deg_per_s"].is_null());
  EXPECT_EQ(read["verdict"], "fail");
  EXPECT_EQ(read["words"], "not finite");
}

TEST(ValidationReport, TableHasARowForEachRunAndSaysWhatFailed) {
  const std::string text = table(validated("none", std::nan(""), "table.h5"));
  // In the table of residuals and in that of recorded rates.
  EXPECT_EQ(lines_with(text, "\ntable.h5 "), 2U);
  EXPECT_EQ(lines_with(text, "\noverall "), 2U);
  EXPECT_EQ(lines_with(text, "\nraw "), 2U);
  EXPECT_EQ(lines_with(text, "FAILED finite: 1320 of 1320"), 1U);
  EXPECT_EQ(lines_with(text, "verdict: not finite"), 1U);
}

TEST(ValidationReport, TablesFitAHundredColumnsWhateverARunIsCalled) {
  const std::string name = std::string(90, 'x') + ".h5";
  const std::string text = table(validated("half", 0.5, name));
  const std::string tables = text.substr(0, text.find("scale factor replayed"));
  std::istringstream lines(tables.substr(0, tables.find("passed ")));
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line); ++rows)
    EXPECT_LE(line.size(), 100U) << line;
  EXPECT_GE(rows, 12U) << text;
  EXPECT_EQ(lines_with(text, "\n" + name + "\n        "), 2U) << text;
  EXPECT_EQ(lines_with(text, "scale factor of recorded rates"), 1U) << text;
}

TEST(ValidationReport, ComparisonHasARowForEachMethodAfterTheRawRate) {
  const std::string text = table(
      std::vector{validated("cubic", 1.0, "a"), validated("bp", 0.1, "a")});
  EXPECT_LT(text.find("uncompensated"), text.find("\ncubic "));
  EXPECT_LT(text.find("\ncubic "), text.find("\nbp "));
  EXPECT_EQ(lines_with(text, "\n"), 4U);
  const auto row = text.substr(text.find("\nbp "));
  // Variance: 1 % of the raw variance; percent of the cubic; - within 2 deg/s.
  EXPECT_NE(row.find("         1           - "), std::string::npos) << text;
}

TEST(ValidationReport, RefusesToCompareScoresOfDifferentRuns) {
  EXPECT_THROW(
      table(std::vector{validated("a", 0.5, "x"), validated("b", 0.5, "y")}),
      std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::validation_report_test
