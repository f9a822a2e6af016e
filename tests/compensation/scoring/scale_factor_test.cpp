// SPDX-License-Identifier: MIT
#include "compensation/scoring/scale_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "compensation/scoring/rate_departure.h"
#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::scale_factor_test {
namespace {

const RecordedRun kTable{
    .duration = 660.0, .step = 0.5, .true_rate = rate_table(100.0, 11, 30.0)};

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> all = values;
  for (double& value : all) {
    value *= factor;
  }
  return all;
}

double raw_slope(const SlopeSums& sums) { return sums.raw / sums.truth; }

TEST(ScaleFactor, IsThatOfAPureScaleError) {
  RecordedRun with_error = kTable;
  with_error.scale_factor = [](double) { return 0.98; };
  const Recording run = with_error.recording();
  const auto answer = scaled(column_values(run, "rate"), 0.5);
  const SlopeSums sums = slope_sums(run, answer);
  EXPECT_NEAR(share_retained(sums).value(), 0.5, 1e-14);
  EXPECT_NEAR(raw_slope(sums), 0.98, 1e-14);
}

TEST(ScaleFactor, IsOneWhateverConstantIsTakenOff) {
  const Recording run = kTable.recording();
  auto answer = column_values(run, "rate");
  for (double& value : answer) {
    value -= 3.0;
  }
  EXPECT_NEAR(*share_retained(slope_sums(run, answer)), 1.0, 1e-14);
}

TEST(ScaleFactor, DoesNotTakeDriftWithTemperatureForScaleFactor) {
  // One sweep of the rates while the gyro warms by 4 K, its bias by 4 deg/s:
  // a line through all samples together would have a slope of 1.02.
  RecordedRun warming = kTable;
  warming.duration = 330.0;
  warming.temperature = [](double t) { return 20.0 + 4.0 * t / 330.0; };
  warming.bias = [](double t) { return 4.0 * t / 330.0; };
  const Recording run = warming.recording();
  const SlopeSums sums = slope_sums(run, column_values(run, "true_rate"));
  // The damping of the fit leaves its own share of the drift.
  EXPECT_NEAR(raw_slope(sums), 1.0, kDriftDamping);
  EXPECT_NEAR(*share_retained(sums), 1.0, kDriftDamping);
}

TEST(ScaleFactor, KeptIsNotMovedByADriftTakenOffAtOneTemperature) {
  // 0.4 deg/s of drift during one sweep of +-2 deg/s: 11 % of its slope.
  RecordedRun sweep = kTable;
  sweep.duration = 330.0;
  sweep.true_rate = rate_table(2.0, 11, 30.0);
  sweep.bias = [](double t) { return 0.4 * t / 330.0; };
  const Recording run = sweep.recording();
  const SlopeSums sums = slope_sums(run, column_values(run, "true_rate"));
  EXPECT_NEAR(*share_retained(sums), 1.0, 1e-4);
}

TEST(ScaleFactor, KeptIsNotMovedByAWarmUpLongBeforeTheSweep) {
  // The drift dies away with 300 s; the rates come after half an hour.
  RecordedRun sweep = kTable;
  const auto table = rate_table(2.0, 11, 60.0);
  sweep.duration = 2460.0;
  sweep.true_rate = [=](double t) {
    return t < 1800.0 ? 0.0 : table(t - 1800.0);
  };
  sweep.bias = [](double t) { return std::exp(-t / 300.0); };
  const Recording run = sweep.recording();
  const SlopeSums sums = slope_sums(run, column_values(run, "true_rate"));
  EXPECT_NEAR(*share_retained(sums), 1.0, 1e-3);
}

TEST(ScaleFactor, OfARateThatRampsIsNotExplainedAwayAsDrift) {
  RecordedRun ramp{.true_rate = [](double t) { return 0.4 * t - 120.0; }};
  const Recording run = ramp.recording();
  const auto answer = scaled(column_values(run, "rate"), 0.5);
  EXPECT_NEAR(*share_retained(slope_sums(run, answer)), 0.5, 1e-9);
}

TEST(ScaleFactor, OfRunsTogetherDoesNotSeeTheirDifferentBias) {
  RecordedRun cold{.duration = 120.0, .true_rate = [](double t) {
                     return t < 60.0 ? -60.0 : 0.0;
                   }};
  cold.bias = [](double) { return -2.0; };
  RecordedRun hot{.duration = 120.0,
                  .true_rate = [](double t) { return t < 60.0 ? 0.0 : 60.0; }};
  hot.bias = [](double) { return 2.0; };
  SlopeSums sums;
  for (const RecordedRun& each : {cold, hot}) {
    const Recording run = each.recording();
    sums += slope_sums(run, column_values(run, "true_rate"));
  }
  EXPECT_NEAR(raw_slope(sums), 1.0, 1e-13);
  EXPECT_EQ(sums.samples, 480U);
}

TEST(ScaleFactor, OfRunsTogetherCountsEachByThePowerOfItsRate) {
  // Of a rate that changes slowly v leaves most out, of a fast swing next to
  // nothing.
  RecordedRun slow{
      .true_rate = [](double t) { return 100.0 * std::sin(0.01 * t); }};
  slow.duration = 2640.0;
  RecordedRun swing{
      .true_rate = [](double t) { return 60.0 * std::sin(0.3 * t); }};
  SlopeSums sums;
  double power = 0.0, kept = 0.0;
  for (const auto& [each, share] : {std::pair{slow, 0.9}, {swing, 1.0}}) {
    const Recording run = each.recording();
    const auto& truth = column_values(run, "true_rate");
    sums += slope_sums(run, scaled(truth, share)).by_power();
    const double mean = std::accumulate(truth.begin(), truth.end(), 0.0) /
                        static_cast<double>(truth.size());
    for (const double rate : truth) {
      power += std::pow(rate - mean, 2);
      kept += share * std::pow(rate - mean, 2);
    }
  }
  EXPECT_NEAR(*share_retained(sums), kept / power, 1e-12);
}

TEST(ScaleFactor, IsMissingWhereTheRateDoesNotVary) {
  RecordedRun still{.true_rate = [](double) { return 10.0; }};
  const Recording run = still.recording();
  EXPECT_FALSE(share_retained(slope_sums(run, column_values(run, "rate"))));

  // Within 2 deg/s a table of 20 deg/s steps has only its zero.
  const Recording table = kTable.recording();
  EXPECT_FALSE(share_retained(
      slope_sums(table, column_values(table, "rate"), kSmallRate)));
}

TEST(ScaleFactor, WithinSmallRatesSeesANetworkThatOnlyEatsThose) {
  RecordedRun sine{
      .true_rate = [](double t) { return 60.0 * std::sin(t / 40.0); }};
  const Recording run = sine.recording();
  auto answer = column_values(run, "rate");
  for (double& value : answer) {
    value -= std::clamp(value, -2.5, 2.5);
  }
  const auto small = share_retained(slope_sums(run, answer, kSmallRate));
  const auto every = share_retained(slope_sums(run, answer));
  EXPECT_NEAR(*small, 0.0, 1e-12);
  EXPECT_GT(*every, 0.9);
  EXPECT_LT(*every, 0.999);
}

TEST(ScaleFactor, WithinSmallRatesLeavesOutWhatIsStillSettlingFromLargeOnes) {
  RecordedRun steps{.duration = 400.0, .step = 0.1};
  steps.true_rate = [](double t) {
    return t < 100.0 ? 1.0 : t < 200.0 ? 100.0 : t < 300.0 ? -1.0 : 0.5;
  };
  Recording run = steps.recording();
  // The output of the first sample after the step still is that before it.
  run.columns[1].values[2000] = 100.0;
  const SlopeSums sums =
      slope_sums(run, column_values(run, "rate"), kSmallRate);
  EXPECT_NEAR(raw_slope(sums), 1.0, 1e-13);
}

TEST(ScaleFactor, LeavesSaturatedSamplesOut) {
  Recording run = kTable.recording();
  auto& rate = run.columns[1].values;
  for (std::size_t k = 0; k < rate.size(); ++k) {
    if (std::abs(rate[k]) > 90.0) {
      rate[k] = std::copysign(50.0, rate[k]);
      run.status[k] |= kOutputSaturated;
    }
  }
  EXPECT_NEAR(raw_slope(slope_sums(run, rate)), 1.0, 1e-13);
}

TEST(ScaleFactor, RefusesAnAnswerOfAnotherLengthAndARunWithoutTruth) {
  Recording run = kTable.recording();
  auto answer = column_values(run, "rate");
  answer.pop_back();
  EXPECT_THROW(slope_sums(run, answer), std::invalid_argument);
  answer.push_back(0.0);
  run.columns.pop_back();
  EXPECT_THROW(slope_sums(run, answer), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::scale_factor_test
