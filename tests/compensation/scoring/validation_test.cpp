// SPDX-License-Identifier: MIT
#include "compensation/scoring/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::validation_test {
namespace {

double drift(double t) { return 1.5 - std::exp(-t / 500.0); }
double warm_up(double t) { return 25.0 + 5.0 * drift(t); }

/// Small and large rates in one run, and a warm-up at rest.
Recording small_and_large_rates() {
  const auto small = rate_table(2.0, 5, 60.0);
  const auto large = rate_table(120.0, 11, 60.0);
  return RecordedRun{
      .duration = 1260.0,
      .true_rate =
          [=](double t) { return t < 600.0 ? small(t) : large(t - 600.0); },
      .bias = drift,
      .temperature = warm_up}
      .recording();
}

/// Applies (rate, bias it had) -> compensated rate to every sample.
AnsweredRun answered(const Recording& run,
                     const std::function<double(double, double)>& law) {
  AnsweredRun answer{.name = "table", .recording = &run};
  const auto& rate = column_values(run, "rate");
  for (std::size_t k = 0; k < rate.size(); ++k) {
    answer.compensated.push_back(law(rate[k], drift(run.time[k])));
  }
  return answer;
}

Validation judged(const std::function<double(double, double)>& law) {
  const Recording run = small_and_large_rates();
  return validate("law", {answered(run, law)});
}

bool passed(const Validation& validation, const std::string& name) {
  const auto found = std::ranges::find(validation.checks, name, &Check::name);
  return found->passed;
}

TEST(Validation, ABiasTakenOffKeepsTheRateAndPasses) {
  const Validation found =
      judged([](double rate, double bias) { return rate - 0.9 * bias; });
  EXPECT_EQ(found.verdict, Verdict::kKeepsRate);
  EXPECT_TRUE(found.passed());
  EXPECT_EQ(found.runs.size(), 1U);
  EXPECT_NEAR(found.overall.residual.rms, 0.1 * found.overall.raw.rms, 1e-12);
}

TEST(Validation, NamesTheCompensatorThatCancelsTheRate) {
  // A network on the output trained at rest: right there, it saturates beyond.
  const Validation found = judged(
      [](double rate, double) { return rate - std::clamp(rate, -4.0, 4.0); });
  EXPECT_EQ(found.verdict, Verdict::kCancelsRate);
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
  EXPECT_LT(found.overall.small_rates->retained, 0.1);
  EXPECT_GT(found.overall.every_rate->retained, 0.9);
  EXPECT_FALSE(passed(found, "scale factor"));
  EXPECT_FALSE(found.passed());
}

TEST(Validation, NamesTheCompensatorThatBendsTheScaleFactor) {
  const Validation found =
      judged([](double rate, double bias) { return 0.998 * (rate - bias); });
  EXPECT_EQ(found.verdict, Verdict::kBendsScaleFactor);
  EXPECT_FALSE(passed(found, "scale factor"));
  EXPECT_TRUE(passed(found, "residual"));
}

TEST(Validation, SmallRatesAloneCanBendTheScaleFactor) {
  const Validation found = judged([](double rate, double bias) {
    return rate - bias - 0.05 * std::clamp(rate - bias, -0.5, 0.5);
  });
  EXPECT_LT(std::abs(found.overall.every_rate->retained - 1.0), 1e-3);
  EXPECT_EQ(found.verdict, Verdict::kBendsScaleFactor);
}

TEST(Validation, ACompensatorThatAddsDriftRemovesNone) {
  const Validation found =
      judged([](double rate, double bias) { return rate + 0.1 * bias; });
  EXPECT_EQ(found.verdict, Verdict::kRemovesNoDrift);
  EXPECT_TRUE(passed(found, "scale factor"));
  EXPECT_FALSE(passed(found, "residual"));
}

TEST(Validation, OneAnswerThatIsNoNumberFailsEverything) {
  int sample = 0;
  const Validation found = judged([&sample](double rate, double bias) {
    return ++sample == 500 ? std::nan("") : rate - bias;
  });
  EXPECT_EQ(found.verdict, Verdict::kNotFinite);
  EXPECT_FALSE(passed(found, "finite"));
  EXPECT_FALSE(passed(found, "scale factor"));
  EXPECT_FALSE(passed(found, "residual"));
  EXPECT_EQ(found.overall.not_finite, 1U);
}

TEST(Validation, AtRestTheScaleFactorIsNotTestedUnlessReplayed) {
  const Recording still =
      RecordedRun{.bias = drift, .temperature = warm_up}.recording();
  AnsweredRun answer =
      answered(still, [](double rate, double bias) { return rate - bias; });
  const Validation untested = validate("law", {answer});
  EXPECT_EQ(untested.verdict, Verdict::kScaleFactorUntested);
  EXPECT_FALSE(untested.passed());

  const auto replayed = [&answer](double retained) {
    answer.replayed = ReplayedScaleFactor{};
    answer.replayed->worst.large = ReplayedBlock{30.0, 25.0, 10.0, retained};
    return validate("law", {answer}).verdict;
  };
  EXPECT_EQ(replayed(1.0 + 1e-9), Verdict::kKeepsRate);
  EXPECT_EQ(replayed(0.03), Verdict::kCancelsRate);
  EXPECT_EQ(replayed(0.97), Verdict::kBendsScaleFactor);
}

TEST(Validation, ErrorsOfTwoRatesTablesDoNotCancel) {
  const Recording run = small_and_large_rates();
  const auto times = [&run](double factor) {
    return answered(run, [factor](double rate, double bias) {
      return factor * (rate - bias);
    });
  };
  const Validation found = validate("law", {times(0.99), times(1.01)});
  EXPECT_NEAR(found.overall.every_rate->retained, 1.0, 1e-3);
  EXPECT_EQ(found.verdict, Verdict::kBendsScaleFactor);
}

TEST(Validation, AScaleFactorThatIsCorrectedIsJudgedByItsSlope) {
  RecordedRun soft{.duration = 660.0, .true_rate = rate_table(100.0, 11, 60.0)};
  soft.scale_factor = [](double) { return 0.97; };
  soft.bias = [](double) { return 1.0; };
  const Recording run = soft.recording();
  AnsweredRun answer{.name = "table", .recording = &run};
  for (const double rate : column_values(run, "rate")) {
    answer.compensated.push_back((rate - 1.0) / 0.97);
  }
  EXPECT_EQ(validate("law", {answer}, {}, true).verdict, Verdict::kKeepsRate);
  EXPECT_EQ(validate("law", {answer}, {}, false).verdict,
            Verdict::kBendsScaleFactor);
}

TEST(Validation, HoldsTheLimitsOfItsSpecification) {
  const Recording run = small_and_large_rates();
  const auto answer = answered(
      run, [](double rate, double bias) { return 0.998 * (rate - bias); });
  EXPECT_TRUE(
      validate("law", {answer}, {.scale_factor_tolerance = 3e-3}).passed());
}

TEST(Validation, RefusesToValidateOnNothing) {
  EXPECT_THROW(validate("law", {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::validation_test
