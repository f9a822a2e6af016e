// SPDX-License-Identifier: MIT
#include "compensation/rows/training_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::training_rows_test {
namespace {

const std::vector<Input> kTemperature{parse_input("temperature")};

TrainingRows rows_from(const Recording& recording,
                       const RowOptions& options = {},
                       const TemperatureRange& range = {},
                       const LookupTable* table = nullptr) {
  return training_rows(source_of({{"run.h5", "", recording}}), kTemperature,
                       options, range, table);
}

RecordedRun drifting_run() {
  RecordedRun run{.duration = 600.0, .step = 0.5};
  run.temperature = [](double t) { return 20.0 + 0.01 * t; };
  run.bias = [](double t) { return 0.5 + 1e-3 * t; };
  run.true_rate = [](double t) { return 10.0 * std::sin(t); };
  return run;
}

TEST(TrainingRows, AreMeansOverBlocksWithTheTrueRateTakenOff) {
  const TrainingRows rows = rows_from(drifting_run().recording());
  ASSERT_EQ(rows.size(), 10);
  for (Eigen::Index k = 0; k < 10; ++k) {
    const double middle = 60.0 * double(k) + 29.75;  // [s] of 120 samples
    EXPECT_NEAR(rows.temperature(k), 20.0 + 0.01 * middle, 1e-12);
    EXPECT_NEAR(rows.inputs(k, 0), rows.temperature(k), 1e-12);
    EXPECT_NEAR(rows.bias(k), 0.5 + 1e-3 * middle, 1e-12);
  }
  EXPECT_EQ(rows.range.lowest, 20.0);
  EXPECT_NEAR(rows.range.highest, 20.0 + 0.01 * 599.5, 1e-12);
}

TEST(TrainingRows, BlocksAreCountedFromEachPowerOn) {
  RecordedRun run = drifting_run();
  run.powered = [](double t) {
    return t >= 30.0 && !(t >= 170.0 && t < 200.0);
  };
  const TrainingRows rows = rows_from(run.recording());
  // 30..90, 90..150, (150..170 is less than half a block), 200..260, ..., and
  // 560..600, which is more than half.
  ASSERT_EQ(rows.size(), 2 + 7);
  EXPECT_NEAR(rows.temperature(0), 20.0 + 0.01 * (30.0 + 29.75), 1e-12);
  EXPECT_NEAR(rows.temperature(2), 20.0 + 0.01 * (200.0 + 29.75), 1e-12);
}

TEST(TrainingRows, SaturatedAndUnlockedSamplesAreLeftOut) {
  Recording recording = drifting_run().recording();
  for (const std::size_t k : {3u, 4u}) {
    recording.status[k] = k == 3 ? kOutputSaturated : kLoopNotLocked;
    recording.columns[1].values[k] = 1e6;
  }
  const TrainingRows rows = rows_from(recording);
  EXPECT_NEAR(rows.bias(0), 0.5 + 1e-3 * 29.75, 1e-3);
}

TEST(TrainingRows, SteadyRowsOnlyWhenAsked) {
  RecordedRun run{.duration = 1200.0, .step = 1.0};
  run.temperature = [](double t) {
    return t < 600.0 ? 20.0 : 20.0 + (t - 600.0) / 60.0;  // 1 K/min
  };
  RowOptions options;
  EXPECT_EQ(rows_from(run.recording(), options).size(), 20);
  options.steady_K_per_min = 0.5;
  const TrainingRows rows = rows_from(run.recording(), options);
  EXPECT_EQ(rows.size(), 10);
  EXPECT_EQ(rows.range.highest, 20.0);
}

// 10 min at rest, 10 min of a ramp whose true rate nobody knows.
TEST(TrainingRows, InputsOfRampsAreKeptWithoutTheirBias) {
  RecordedRun run{.duration = 1200.0, .step = 10.0};
  run.temperature = [](double t) {
    return t < 600.0 ? 20.0 : 20.0 + (t - 600.0) / 60.0;
  };
  run.true_rate = [](double t) { return t < 600.0 ? 0.0 : NAN; };
  RowOptions options;
  options.steady_K_per_min = 0.5;
  const TrainingRows rows = rows_from(run.recording(), options);
  EXPECT_EQ(rows.size(), 10);
  ASSERT_EQ(rows.moving.rows(), 10);
  ASSERT_EQ(rows.moving.cols(), 1);
  // Six samples of a minute begin at its start.
  for (int k = 0; k < 10; ++k)
    EXPECT_NEAR(rows.moving(k, 0), 20.0 + k + 25.0 / 60.0, 1e-12);
}

TEST(TrainingRows, HaveTheTemperatureThatTheSensorWouldSettleTo) {
  // The sensor settles with 8 min at 20 degC, and the beam lags by as much.
  RecordedRun run{.duration = 1800.0, .step = 10.0};
  run.temperature = [](double t) { return 20.0 + 4.0 * std::exp(-t / 480.0); };
  RowOptions options;
  options.lag_min = 8.0;
  const TrainingRows rows = rows_from(run.recording(), options);
  ASSERT_EQ(rows.size(), 30);
  for (Eigen::Index k = 2; k < rows.size() - 2; ++k)
    // The chord of the exponential over four minutes is 1 % steeper.
    EXPECT_NEAR(rows.temperature(k), 20.0 + 8.0 * std::exp(-rows.time(k) / 480),
                0.05);
  EXPECT_LT((rows.inputs.col(0) - rows.temperature).abs().maxCoeff(), 1e-12);
}

TEST(TrainingRows, OfTheMinutesAfterEachPowerOnMayBeLeftOut) {
  RecordedRun run{.duration = 1800.0, .step = 10.0};
  run.powered = [](double t) { return t < 600.0 || t >= 660.0; };
  RowOptions options;
  options.after_power_on_min = 5.0;
  const TrainingRows rows = rows_from(run.recording(), options);
  // Of two cycles of 10 and 19 minutes, each without its first five.
  ASSERT_EQ(rows.size(), 5 + 14);
  EXPECT_EQ(rows.time(0), 325.0);
  EXPECT_EQ(rows.time(5), 660.0 + 325.0);
  options.after_power_on_min = 40.0;
  EXPECT_TRUE(holds(rejection([&] { rows_from(run.recording(), options); }),
                    "later than 40 min after power-on"));
}

TEST(TrainingRows, BadRunsAreNamedWithWhatIsWrong) {
  const Recording good = drifting_run().recording();
  const auto message = [](const Recording& recording) {
    return rejection([&] { rows_from(recording); });
  };
  Recording no_truth = good;
  no_truth.columns.pop_back();
  EXPECT_TRUE(holds(message(no_truth), "run.h5: "));
  EXPECT_TRUE(holds(message(no_truth), "true_rate"));

  RecordedRun off = drifting_run();
  off.powered = [](double) { return false; };
  EXPECT_EQ(message(off.recording()),
            "run.h5: no sample is powered, locked and not saturated");

  Recording nan = good;
  nan.columns[1].values[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(holds(message(nan), "rate - true_rate is nan at t = 2.5 s"));
}

TEST(TrainingRows, NoSteadyRowIsAnError) {
  const RowOptions options{.steady_K_per_min = 0.1};
  EXPECT_TRUE(
      holds(rejection([&] { rows_from(drifting_run().recording(), options); }),
            "no row whose temperature changes by 0.1 K/min or less"));
}

std::vector<int> numbers(const Eigen::ArrayXi& values) {
  return {values.begin(), values.end()};
}

TEST(TrainingRows, KnowTheirTimeRunAndPowerCycle) {
  RecordedRun first = drifting_run();
  first.duration = 480.0;
  first.powered = [](double t) { return t < 120.0 || t >= 240.0; };
  RecordedRun second = drifting_run();
  second.duration = 120.0;
  const TrainingRows rows =
      training_rows(source_of({{"a.h5", "", first.recording()},
                               {"b.h5", "", second.recording()}}),
                    kTemperature, {});
  ASSERT_EQ(rows.size(), 2 + 4 + 2);
  EXPECT_NEAR(rows.time(1), 89.75, 1e-12);
  EXPECT_NEAR(rows.time(2), 269.75, 1e-12);
  EXPECT_NEAR(rows.time(6), 29.75, 1e-12);
  EXPECT_EQ(numbers(rows.run), (std::vector<int>{0, 0, 0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(numbers(rows.cycle), (std::vector<int>{0, 0, 1, 1, 1, 1, 2, 2}));
  EXPECT_EQ(numbers(rows.leg), (std::vector<int>{0, 0, 1, 1, 1, 1, 2, 2}));
  EXPECT_TRUE((rows.beyond_range == 0.0).all());
}

/// Rows of 60 samples at the temperatures given, one after the other.
TrainingRows rows_at(const std::vector<double>& temperatures) {
  RecordedRun run{.duration = 60.0 * double(temperatures.size()), .step = 1.0};
  run.temperature = [&](double t) {
    return temperatures[static_cast<std::size_t>(t / 60.0)];
  };
  return rows_from(run.recording());
}

TEST(TrainingRows, LegsEndWhereTheTemperatureTurns) {
  EXPECT_EQ(numbers(rows_at({20, 25, 30, 35, 30, 25, 20, 15, 20, 25}).leg),
            (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2}));
  // Falling at first.
  EXPECT_EQ(numbers(rows_at({20, 15, 10, 15, 20}).leg),
            (std::vector<int>{0, 0, 0, 1, 1}));
}

TEST(TrainingRows, ATurnSmallerThanTwoKelvinsIsNoise) {
  EXPECT_EQ(numbers(rows_at({20, 25, 23.1, 30, 28.1, 35, 33.5}).leg),
            (std::vector<int>(7, 0)));
  EXPECT_EQ(numbers(rows_at({20, 25, 23.0, 30}).leg),
            (std::vector<int>{0, 0, 1, 2}));
  EXPECT_EQ(numbers(rows_at({20, 20.9, 19.1, 20.8, 19.2}).leg),
            (std::vector<int>(5, 0)));
}

TEST(TrainingRows, APlateauBelongsToTheLegThatLedToIt) {
  EXPECT_EQ(numbers(rows_at({20, 30, 40, 40, 40, 30, 20, 20, 30}).leg),
            (std::vector<int>{0, 0, 0, 0, 0, 1, 1, 1, 2}));
  // With noise its last extreme parts it.
  EXPECT_EQ(numbers(rows_at({20, 30, 40, 39.9, 40.1, 39.8, 30, 20}).leg),
            (std::vector<int>{0, 0, 0, 0, 0, 1, 1, 1}));
}

TEST(TrainingRows, WithoutSecondsEverySampleIsARow) {
  RecordedRun run = drifting_run();
  run.duration = 10.0;
  run.powered = [](double t) { return t < 3.0 || t >= 4.0; };
  Recording recording = run.recording();
  recording.status[1] |= kOutputSaturated;
  RowOptions options;
  options.seconds = 0.0;
  const TrainingRows rows = rows_from(recording, options);
  ASSERT_EQ(rows.size(), 20 - 2 - 1);
  EXPECT_EQ(rows.time(0), 0.0);
  EXPECT_EQ(rows.time(1), 1.0);
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    EXPECT_NEAR(rows.temperature(k), 20.0 + 0.01 * rows.time(k), 1e-12);
    EXPECT_NEAR(rows.bias(k), 0.5 + 1e-3 * rows.time(k), 1e-12);
    EXPECT_EQ(rows.cycle(k), rows.time(k) < 3.0 ? 0 : 1);
  }
}

TEST(TrainingRows, RateAndOutputTellVoltsPerDegreeEvenWithGapsInPower) {
  RecordedRun run = drifting_run();
  for (const bool gap : {false, true}) {
    run.powered = [gap](double t) {
      return !gap || (t > 10.0 && t < 200.0) || t > 300.0;
    };
    const TrainingRows rows = rows_from(run.recording());
    EXPECT_NEAR(rows.output_per_rate, 0.0125, 1e-9) << gap;
    EXPECT_NEAR(rows.true_rate_span, 20.0, 0.02);
  }
  Recording turned = run.recording();  // output falls with the rate
  for (double& volts : turned.columns[0].values) volts = 5.0 - volts;
  EXPECT_NEAR(rows_from(turned).output_per_rate, -0.0125, 1e-9);
  turned.columns.erase(turned.columns.begin());
  EXPECT_EQ(rows_from(turned).output_per_rate, 0.0);
}

TEST(TrainingRows, WithAScaleFactorTheLabelIsWhatItLeaves) {
  RecordedRun run = drifting_run();
  const LookupTable table{Eigen::ArrayXd::LinSpaced(2, 20.0, 26.0),
                          Eigen::ArrayXd::LinSpaced(2, 0.9, 1.2)};
  run.scale_factor = [=](double t) { return table.at(20.0 + 0.01 * t); };
  const TrainingRows rows = rows_from(run.recording(), {}, {}, &table);
  for (Eigen::Index k = 0; k < rows.size(); ++k)
    EXPECT_NEAR(rows.bias(k), 0.5 + 1e-3 * rows.time(k), 1e-12);

  // Temperatures are clamped before the table is asked, as at run time.
  const double held = table.at(22.0);
  run.scale_factor = [=](double t) { return std::min(0.9 + 5e-4 * t, held); };
  const TrainingRows clamped =
      rows_from(run.recording(), {}, {20.0, 22.0}, &table);
  EXPECT_NEAR(clamped.bias(9), 0.5 + 1e-3 * clamped.time(9), 1e-12);
  EXPECT_EQ(clamped.temperature(9), 22.0);
  EXPECT_GT(clamped.beyond_range(9), 0.0);
  EXPECT_EQ(clamped.beyond_range(0), 0.0);
}

TEST(TrainingRows, SelectedRowsKeepAllThatBelongsToThem) {
  RecordedRun run = drifting_run();
  run.powered = [](double t) { return t < 300.0 || t >= 310.0; };
  const TrainingRows rows = rows_from(run.recording(), {}, {20.0, 22.0});
  Eigen::Array<bool, Eigen::Dynamic, 1> keep =
      rows.time > 200.0 && rows.time < 400.0;
  const TrainingRows some = selected(rows, keep);
  ASSERT_EQ(some.size(), keep.count());
  Eigen::Index first = 0;
  while (!keep(first)) ++first;
  for (Eigen::Index k = 0; k < some.size(); ++k) {
    EXPECT_EQ(some.inputs(k, 0), rows.inputs(first + k, 0));
    EXPECT_EQ(some.temperature(k), rows.temperature(first + k));
    EXPECT_EQ(some.bias(k), rows.bias(first + k));
    EXPECT_EQ(some.time(k), rows.time(first + k));
    EXPECT_EQ(some.cycle(k), rows.cycle(first + k));
    EXPECT_EQ(some.leg(k), rows.leg(first + k));
    EXPECT_EQ(some.beyond_range(k), rows.beyond_range(first + k));
  }
  EXPECT_EQ(some.range, rows.range);
}

TEST(TrainingRows, ColumnsAreTakenByTheNameOfTheirInput) {
  const std::vector<Input> all{parse_input("temperature"),
                               parse_input("output"), parse_input("rate")};
  const TrainingRows rows = training_rows(
      source_of({{"run", "", drifting_run().recording()}}), all, {});
  const TrainingRows two = with_columns(rows, all, {all[2], all[0]});
  EXPECT_TRUE((two.inputs.col(0) == rows.inputs.col(2)).all());
  EXPECT_TRUE((two.inputs.col(1) == rows.inputs.col(0)).all());
  EXPECT_EQ(two.inputs.cols(), 2);
}

}  // namespace
}  // namespace beamgyro::internal::training_rows_test
