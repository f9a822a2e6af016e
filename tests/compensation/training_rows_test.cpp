// SPDX-License-Identifier: MIT
#include "compensation/training_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/compensation/message_of.h"
#include "tests/compensation/recorded_run.h"

namespace beamgyro {
namespace {

const std::vector<Input> kTemperature{parse_input("temperature")};

std::vector<TrainingRun> one(const Recording& recording) {
  return {{"run.h5", "", recording}};
}

RecordedRun drifting_run() {
  RecordedRun run{.duration = 600.0, .step = 0.5};
  run.temperature = [](double t) { return 20.0 + 0.01 * t; };
  run.bias = [](double t) { return 0.5 + 1e-3 * t; };
  run.true_rate = [](double t) { return 10.0 * std::sin(t); };
  return run;
}

TEST(TrainingRows, AreMeansOverBlocksWithTheTrueRateTakenOff) {
  const TrainingRows rows =
      training_rows(one(drifting_run().recording()), kTemperature, {});
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
  const TrainingRows rows =
      training_rows(one(run.recording()), kTemperature, {});
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
  const TrainingRows rows = training_rows(one(recording), kTemperature, {});
  EXPECT_NEAR(rows.bias(0), 0.5 + 1e-3 * 29.75, 1e-3);
}

TEST(TrainingRows, SteadyRowsOnlyWhenAsked) {
  RecordedRun run{.duration = 1200.0, .step = 1.0};
  run.temperature = [](double t) {
    return t < 600.0 ? 20.0 : 20.0 + (t - 600.0) / 60.0;  // 1 K/min
  };
  RowOptions options;
  EXPECT_EQ(training_rows(one(run.recording()), kTemperature, options).size(),
            20);
  options.steady_K_per_min = 0.5;
  const TrainingRows rows =
      training_rows(one(run.recording()), kTemperature, options);
  EXPECT_EQ(rows.size(), 10);
  EXPECT_EQ(rows.range.highest, 20.0);
}

TEST(TrainingRows, BadRunsAreNamedWithWhatIsWrong) {
  const Recording good = drifting_run().recording();
  const auto message = [](const Recording& recording) {
    return message_of([&] { training_rows(one(recording), kTemperature, {}); });
  };
  Recording no_truth = good;
  no_truth.columns.pop_back();
  EXPECT_NE(message(no_truth).find("run.h5: "), std::string::npos);
  EXPECT_NE(message(no_truth).find("true_rate"), std::string::npos);

  RecordedRun off = drifting_run();
  off.powered = [](double) { return false; };
  EXPECT_EQ(message(off.recording()),
            "run.h5: no sample is powered, locked and not saturated");

  Recording nan = good;
  nan.columns[1].values[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(nan).find("rate - true_rate is nan at t = 2.5 s"),
            std::string::npos);
}

TEST(TrainingRows, NoSteadyRowIsAnError) {
  RowOptions options;
  options.steady_K_per_min = 0.1;
  EXPECT_NE(message_of([&] {
              training_rows(one(drifting_run().recording()), kTemperature,
                            options);
            }).find("no row whose temperature changes by 0.1 K/min or less"),
            std::string::npos);
}

}  // namespace
}  // namespace beamgyro
