// SPDX-License-Identifier: MIT
#include "compensation/compensator/compensator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::compensator_test {
namespace {

// bias = 1 + 0.1 T, baseline = 2, between 0 and 40 degC
FittedCompensator linear_compensator() {
  FittedCompensator c;
  c.inputs = {parse_input("temperature")};
  c.bias = {{Scale{}}, {}, Polynomial{{1.0, 0.1}}};
  c.baseline = {{Scale{}}, {}, Polynomial{{2.0}}};
  c.temperature_range = {.lowest = 0.0, .highest = 40.0};
  return c;
}

TEST(Compensator, TakesThePredictedBiasOffTheRate) {
  RecordedRun run{.duration = 100.0, .step = 0.01};  // more than one block
  run.temperature = [](double t) { return 0.4 * t; };
  run.bias = [](double t) { return 1.0 + 0.04 * t; };
  run.true_rate = [](double t) { return std::sin(t); };
  const Recording recording = run.recording();
  const std::vector<double> rate =
      compensated_rate(linear_compensator(), recording);
  const std::vector<double> baseline =
      baseline_rate(linear_compensator(), recording);
  for (std::size_t k = 0; k < rate.size(); ++k) {
    const double t = recording.time[k];
    ASSERT_NEAR(rate[k], std::sin(t), 1e-13);
    ASSERT_NEAR(baseline[k], std::sin(t) + 1.0 + 0.04 * t - 2.0, 1e-13);
  }
}

TEST(Compensator, ClampsTheTemperatureAndCountsTheSamples) {
  RecordedRun run{.duration = 70.0, .step = 1.0};
  run.temperature = [](double t) { return t - 10.0; };
  run.powered = [](double t) { return t >= 5.0; };
  const Recording recording = run.recording();
  const std::vector<double> rate =
      compensated_rate(linear_compensator(), recording);
  EXPECT_TRUE(std::isnan(rate[4]));
  EXPECT_EQ(rate[5], -1.0);                    // at -5 as at 0 degC
  EXPECT_NEAR(rate[69], -(1.0 + 4.0), 1e-14);  // at 59 as at 40 degC
  EXPECT_EQ(clamped_samples(linear_compensator(), recording), 5u + 19u);
}

TEST(Compensator, MissingInputIsNamed) {
  Recording recording = RecordedRun{}.recording();
  recording.columns.erase(recording.columns.begin() + 2);
  EXPECT_TRUE(holds(
      rejection([&] { compensated_rate(linear_compensator(), recording); }),
      "input \"temperature\" needs the measured column"));
}

TEST(Compensator, RateOfABiasOnlyModelPassesExactly) {
  RecordedRun run{.duration = 100.0, .step = 1.0};
  run.temperature = [](double t) { return 0.4 * t; };
  const std::vector<double> still =
      compensated_rate(linear_compensator(), run.recording());
  run.true_rate = [](double) { return 64.0; };
  const std::vector<double> turning =
      compensated_rate(linear_compensator(), run.recording());
  for (std::size_t k = 0; k < still.size(); ++k)
    EXPECT_NEAR(turning[k] - still[k], 64.0, 1e-12);
}

// s from 0.9 at 0 to 1.1 at 50 degC, of which the range takes 0 ... 40.
FittedCompensator scaling_compensator() {
  FittedCompensator c = linear_compensator();
  c.scale_factor = LookupTable{Eigen::ArrayXd::LinSpaced(2, 0.0, 50.0),
                               Eigen::ArrayXd::LinSpaced(2, 0.9, 1.1)};
  return c;
}

TEST(Compensator, DividesWhatTheBiasLeavesByTheScaleFactor) {
  RecordedRun run{.duration = 100.0, .step = 0.01};
  run.temperature = [](double t) { return 0.4 * t; };
  run.scale_factor = [](double t) { return 0.9 + 0.004 * 0.4 * t; };
  run.bias = [](double t) { return 1.0 + 0.04 * t; };
  run.true_rate = [](double t) { return 50.0 * std::sin(t); };
  const Recording recording = run.recording();
  const std::vector<double> rate =
      compensated_rate(scaling_compensator(), recording);
  for (std::size_t k = 0; k < rate.size(); ++k)
    ASSERT_NEAR(rate[k], 50.0 * std::sin(recording.time[k]), 1e-12);
  // The baseline has s = 1.
  EXPECT_EQ(baseline_rate(scaling_compensator(), recording),
            baseline_rate(linear_compensator(), recording));
}

TEST(Compensator, ClampsTheTemperatureOfTheScaleFactorToo) {
  RecordedRun run{.duration = 60.0, .step = 1.0};
  run.temperature = [](double t) { return t < 30.0 ? -60.0 : 90.0; };
  run.true_rate = [](double) { return 10.0; };
  const std::vector<double> rate =
      compensated_rate(scaling_compensator(), run.recording());
  EXPECT_NEAR(rate[0], (10.0 - 1.0) / 0.9, 1e-13);
  EXPECT_NEAR(rate[59], (10.0 - 5.0) / 1.06, 1e-13);
}

TEST(Compensator, ScaleFactorAtNoFiniteTemperatureIsAnError) {
  FittedCompensator c = scaling_compensator();
  c.inputs = {parse_input("output")};  // the bias does not ask for it
  c.bias = {{Scale{}}, {}, NoBias{}};
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Recording recording = RecordedRun{}.recording();
    std::ranges::find(recording.columns, "temperature", &Column::name)
        ->values[7] = bad;
    EXPECT_TRUE(holds(rejection([&] { compensated_rate(c, recording); }),
                      "at t = 3.5 s though the gyro is powered"));
  }
}

TEST(Compensator, NoKindAnswersWhereThereIsNoPower) {
  RecordedRun run{.duration = 40.0, .step = 1.0};
  run.temperature = [](double t) { return t; };
  Recording recording = run.recording();
  for (std::size_t k = 10; k < 20; ++k) recording.status[k] |= kUnpowered;
  for (const auto& [name, c] : one_of_each_kind()) {
    if (c.inputs.size() > 1 && name != "bp") continue;  // loop signals
    const std::vector<double> rate = compensated_rate(c, recording);
    for (std::size_t k = 0; k < rate.size(); ++k)
      EXPECT_EQ(std::isnan(rate[k]), k >= 10 && k < 20) << name << " " << k;
  }
}

}  // namespace
}  // namespace beamgyro::internal::compensator_test
