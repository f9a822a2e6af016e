// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/compensation/recorded_run.h"
#include "validation/checks/check_context.h"
#include "validation/checks/temperature_sweep.h"
#include "validation/checks/white_number.h"

namespace beamgyro::internal::temperature_checks_test {
namespace {

RecordedRun run_with(std::function<double(double)> temperature) {
  RecordedRun run{.duration = 3600.0, .step = 1.0};
  run.bias = [](double t) { return 1e-3 * t; };
  run.temperature = std::move(temperature);
  return run;
}

CheckResult of_temperature(const RecordedRun& made) {
  const Recording run = made.recording();
  const FunctionCompensator identity(
      [](const Recording& any) { return column_values(any, "rate"); });
  CheckedCompensator all;
  all.compensator = &identity;
  all.runs.push_back(
      {.name = "run", .recording = &run, .answer = identity.answer(run)});
  return check_temperature_input(CheckContext(all, 1));
}

TEST(TemperatureInput, ASlowOneIsInOrder) {
  const CheckResult found =
      of_temperature(run_with([](double t) { return 0.02 * t; }));
  EXPECT_TRUE(found.passed()) << found.words;
  EXPECT_LT(*found.value, 1e-6);
}

TEST(TemperatureInput, WhiteNoiseIsNone) {
  const CheckResult found = of_temperature(run_with([](double t) {
    return 20.0 * white_number(static_cast<std::size_t>(t));
  }));
  EXPECT_EQ(found.outcome, CheckOutcome::kFailed);
  EXPECT_NEAR(*found.value, 1.0, 0.1);
}

TEST(TemperatureInput, AStuckSensorShowsOnlyWhereTheGyroDrifts) {
  RecordedRun run = run_with([](double) { return 25.0; });
  EXPECT_EQ(of_temperature(run).outcome, CheckOutcome::kFailed);
  RecordedRun noisy = run_with([](double t) {
    return 25.0 + 0.02 * std::round(2.0 * std::sin(7.0 * t));
  });
  EXPECT_EQ(of_temperature(noisy).outcome, CheckOutcome::kFailed);
  run.bias = [](double) { return 1.0; };
  EXPECT_EQ(of_temperature(run).outcome, CheckOutcome::kNotTested);
}

TEST(TemperatureSweep, IsAGyroAtRestOverARange) {
  RecordedRun made = run_with([](double t) { return 0.01 * t; });
  made.bias = [](double) { return 3.0; };
  made.true_rate = rate_table(100.0, 11, 60.0);
  const Recording sweep = temperature_sweep(made.recording(), {-1.0, 2.01});
  const auto& temperature = column_values(sweep, "temperature");
  EXPECT_EQ(temperature.front(), -1.0);
  EXPECT_EQ(temperature[temperature.size() / 2], 2.01);
  EXPECT_EQ(temperature.back(), -1.0);
  for (std::size_t k = 1; k < temperature.size(); ++k)
    ASSERT_LE(std::abs(temperature[k] - temperature[k - 1]),
              kSweepStep + 1e-12);
  for (const double rate : column_values(sweep, "rate"))
    ASSERT_NEAR(rate, 3.0, 0.0101);
  EXPECT_LT(temperature_sweep(made.recording(), {-1e9, 1e9}).time.size(),
            40000u);
}

}  // namespace
}  // namespace beamgyro::internal::temperature_checks_test
