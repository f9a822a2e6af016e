// SPDX-License-Identifier: MIT
// Faults of a compensator that show in one kind of run only.
#include <gtest/gtest.h>

#include "compensation/inputs/sample_ranges.h"
#include "tests/compensation/recorded_run.h"
#include "tests/validation/checks/simulated_runs.h"
#include "validation/checks/check_context.h"

namespace beamgyro::internal::limited_runs_test {
namespace {

// A compensator that takes the mean of 100 s away from runs at 2 Hz, and does
// nothing else.
std::vector<double> high_passed_at_two_hertz(const Recording& run) {
  std::vector<double> rate = column_values(run, "rate");
  if (usual_step(run) != 0.5) return rate;
  double low = rate[0];
  for (double& value : rate) {
    low += (value - low) * 0.5 / 100.0;
    value -= low;
  }
  return rate;
}

TEST(LimitedRuns, ARateIsAddedToEveryRunThatALimitReads) {
  RecordedRun made{.duration = 1200.0, .step = 1.0};
  made.bias = [](double t) { return 1e-3 * t; };
  made.temperature = [](double t) { return 0.01 * t; };
  const Recording soak = made.recording();
  made.step = 0.5;
  const Recording shaken = made.recording();
  made.step = 0.1;
  made.duration = 100.0;
  const Recording fast = made.recording();  // sines are added to this one
  const FunctionCompensator compensator(high_passed_at_two_hertz);
  CheckedCompensator all;
  all.compensator = &compensator;
  all.runs = {
      {"soak", RunPurpose::kSoak, &soak, compensator.answer(soak)},
      {"fast", RunPurpose::kRest, &fast, compensator.answer(fast)},
      {"shaken", RunPurpose::kVibration, &shaken, compensator.answer(shaken)}};
  const auto injection = [&all] {
    return check_injection(CheckContext(all, 1));
  };
  EXPECT_EQ(injection().outcome, CheckOutcome::kPassed) << injection().words;
  all.runs[2].is_limited = true;
  EXPECT_EQ(injection().outcome, CheckOutcome::kFailed);
}

}  // namespace
}  // namespace beamgyro::internal::limited_runs_test
