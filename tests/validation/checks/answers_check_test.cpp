// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "tests/validation/checks/simulated_runs.h"
#include "validation/checks/check_context.h"

namespace beamgyro::internal::answers_check_test {
namespace {

TEST(AnswersCheck, ARunThatWasStoppedIsNotAnswered) {
  const FunctionCompensator compensator(
      [](const Recording& run) { return column_values(run, "rate"); });
  const SimulatedRun& rest = simulated_runs().back();
  CheckedCompensator stopped;
  stopped.compensator = &compensator;
  stopped.runs.push_back({.name = rest.name,
                          .purpose = rest.purpose,
                          .recording = &rest.recording,
                          .answer = compensator.answer(rest.recording)});
  Answer& answer = stopped.runs[0].answer;
  answer.rate.back() = NAN;
  answer.faults.push_back({AnswerFault::kStopped, answer.rate.size() - 1,
                           "slower than real time: stopped"});
  std::size_t seen = 0;
  for (const CheckResult& result : run_checks(stopped)) {
    if (result.name != "answers" && result.name != "real_time") continue;
    ++seen;
    EXPECT_EQ(result.outcome, CheckOutcome::kFailed) << result.words;
    EXPECT_NE(result.words.find("stopped"), result.words.npos);
  }
  EXPECT_EQ(seen, 2U);
}

}  // namespace
}  // namespace beamgyro::internal::answers_check_test
