// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <thread>

#include "compensation/compensator/compensator.h"
#include "tests/config/rejection.h"
#include "tests/validation/external/tested_run.h"
#include "validation/external/answer_checks.h"
#include "validation/external/answering.h"

namespace beamgyro::internal::library_test {
namespace {

using enum AnswerFault;

constexpr std::size_t kFaultySample = 700;  // of faulty_plugin.c

void expect_none_by_comparison(const TestedCompensator& compensator) {
  EXPECT_FALSE(state_kept_over_reset(compensator, tested_run()));
  EXPECT_FALSE(later_samples_used(compensator, tested_run()));
}

}  // namespace

TEST(LibraryCompensator, AnswersEveryPoweredSample) {
  const Recording run = tested_run();
  for (const char* name : {"NONE", "PRINTS"}) {
    const auto library = faulty_plugin(name);
    const Answer answer = library->answer(run);
    EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
    ASSERT_EQ(answer.rate.size(), run.time.size());
    const auto& rate = column_values(run, "rate");
    const auto& temperature = column_values(run, "temperature");
    for (std::size_t k = 0; k < run.time.size(); ++k) {
      if ((run.status[k] & kUnpowered) != 0)
        EXPECT_TRUE(std::isnan(answer.rate[k]));
      else
        EXPECT_EQ(answer.rate[k], rate[k] - 0.01 * temperature[k]);
    }
    expect_none_by_comparison(*library);
  }
}

// A sample is longer than what is read at once. The samples are minutes apart,
// so that no load of the machine makes the answers slower than the run.
TEST(LibraryCompensator, MayNameTwentyThousandSignals) {
  Recording run = tested_run(0.1);
  for (double& time : run.time) time *= 10'000;
  const Answer answer = faulty_plugin("WANTS_MANY")->answer(run);
  EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
  EXPECT_EQ(difference_of(answer, faulty_plugin("NONE")->answer(run)).largest,
            0.0);
}

TEST(LibraryCompensator, ReadsTheSignalsThatItNames) {
  EXPECT_EQ(faulty_plugin("NONE")->inputs(),
            (std::vector<std::string>{"rate", "temperature"}));
}

TEST(LibraryCompensator, AnswersAreTheSameFromSeveralThreads) {
  const auto library = faulty_plugin("NONE");
  const Recording run = tested_run();
  std::vector<Answer> answers(8);
  {
    std::vector<std::jthread> threads;
    for (Answer& answer : answers)
      threads.emplace_back([&] { answer = library->answer(run); });
  }
  for (const Answer& answer : answers) {
    EXPECT_TRUE(answer.faults.empty());
    EXPECT_EQ(difference_of(answer, answers[0]).largest, 0.0);
  }
}

TEST(LibraryCompensator, ACrashIsReportedAtItsSample) {
  const SeenFault crash = only_fault(*faulty_plugin("CRASHES"));
  EXPECT_EQ(crash.fault, kCrashed);
  EXPECT_EQ(crash.sample, kFaultySample);
  EXPECT_EQ(crash.words,
            "crashed (signal 11, Segmentation fault) at sample 700 (7 s)");
  const SeenFault abort = only_fault(*faulty_plugin("ABORTS"));
  EXPECT_EQ(abort.fault, kCrashed);
  EXPECT_EQ(abort.sample, kFaultySample);
  const SeenFault recursion = only_fault(*faulty_plugin("RECURSES"));
  EXPECT_EQ(recursion.fault, kCrashed);
  EXPECT_EQ(recursion.sample, kFaultySample);
}

TEST(LibraryCompensator, AnExitInTheMiddleIsNoEnd) {
  const SeenFault exit = only_fault(*faulty_plugin("EXITS"));
  EXPECT_EQ(exit.fault, kCrashed);
  EXPECT_LE(exit.sample, kFaultySample);
}

TEST(LibraryCompensator, AHangIsStopped) {
  const Stopwatch watch;
  const SeenFault hang = only_fault(*faulty_plugin("HANGS"));
  EXPECT_EQ(hang.fault, kTimedOut);
  EXPECT_LE(hang.sample, kFaultySample);
  EXPECT_GT(hang.sample + 64, kFaultySample);  // answers of one batch
  // A guard against a limit that does not hold; a busy machine stays far below.
  EXPECT_LT(watch.seconds(), 60.0 * test_limits().stall);
}

TEST(LibraryCompensator, TooMuchMemoryIsRefused) {
  if (test_limits().memory == 0) GTEST_SKIP() << "a sanitizer needs it";
  const SeenFault at_once = only_fault(*faulty_plugin("USES_NO_MEMORY"));
  EXPECT_EQ(at_once.fault, kOutOfMemory) << at_once.words;
  EXPECT_EQ(at_once.sample, kFaultySample);
  const SeenFault by_and_by = only_fault(*faulty_plugin("LEAKS"));
  EXPECT_EQ(by_and_by.fault, kOutOfMemory) << by_and_by.words;
}

TEST(LibraryCompensator, OneNaNOfAHundredThousandAnswersIsFound) {
  const auto library = faulty_plugin("ANSWERS_NAN");
  const SeenFault nan = only_fault(*library, tested_run(1000.0));
  EXPECT_EQ(nan.fault, kNotFinite);
  EXPECT_EQ(nan.sample, kFaultySample);
  expect_none_by_comparison(*library);
}

TEST(LibraryCompensator, StateKeptOverAResetIsFound) {
  const auto library = faulty_plugin("KEEPS_STATE");
  EXPECT_TRUE(library->answer(tested_run()).faults.empty());
  const auto kept = state_kept_over_reset(*library, tested_run());
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->fault, kKeepsState);
  EXPECT_EQ(kept->sample, 0u);
  EXPECT_FALSE(later_samples_used(*library, tested_run()));
}

TEST(LibraryCompensator, SlowerThanRealTimeIsSaid) {
  const SeenFault slow = only_fault(*faulty_plugin("IS_SLOW"), tested_run(1.0));
  EXPECT_EQ(slow.fault, kTooSlow) << slow.words;
}

TEST(LibraryCompensator, ARefusedPeriodIsSaid) {
  const SeenFault refusal = only_fault(*faulty_plugin("REFUSES_PERIOD"));
  EXPECT_EQ(refusal.fault, kCrashed);
  EXPECT_TRUE(
      holds(refusal.words, "reset() returned -1 for a period of 0.01 s"));
}

TEST(LibraryCompensator, ALaterRunIsNotAskedAfterACrash) {
  const Recording run = tested_run();
  const auto answers = faulty_plugin("CRASHES")->answers({&run, &run});
  ASSERT_EQ(answers.size(), 2u);
  ASSERT_EQ(answers[1].faults.size(), 1u);
  EXPECT_EQ(answers[1].faults[0].fault, kCrashed);
}

TEST(LibraryCompensator, WhatIsNoPluginIsRefused) {
  const auto refusal = [](const std::string& name) {
    return rejection([&] { faulty_plugin(name); });
  };
  EXPECT_TRUE(holds(refusal("OTHER_VERSION"), "version 77"));
  EXPECT_TRUE(holds(refusal("LACKS_A_FUNCTION"), "beamgyro_plugin_step"));
  EXPECT_TRUE(holds(refusal("WANTS_TRUTH"), "\"true_rate\", which no gyro"));
  EXPECT_TRUE(holds(refusal("CRASHES_WHEN_LOADED"), "signal 11"));
  EXPECT_TRUE(holds(refusal("HANGS_WHEN_LOADED"), "hung"));
  EXPECT_TRUE(holds(refusal("EXITS_WHEN_LOADED"),
                    "ended with status 0 before it told its signals"));
  EXPECT_TRUE(
      holds(refusal("TELLS_WITHOUT_END"), "tells more than 33554432 bytes"));
  EXPECT_TRUE(holds(refusal("WANTS_NOTHING"), "asks for \"\""));
  EXPECT_TRUE(holds(refusal("missing"), "No such file"));
}

TEST(LibraryCompensator, StatesWhatItWasTrainedOnOrNothing) {
  EXPECT_EQ(faulty_plugin("NONE")->provenance(), nullptr);
  const auto library = faulty_plugin("STATES_ITS_TRAINING");
  EXPECT_EQ(library->inputs(),
            (std::vector<std::string>{"rate", "temperature"}));
  ASSERT_NE(library->provenance(), nullptr);
  EXPECT_EQ(library->provenance()->training,
            (std::vector<SourceFile>{{"a.h5", "0123"}}));
  const std::string refusal =
      rejection([] { faulty_plugin("STATES_NONSENSE"); });
  EXPECT_TRUE(holds(refusal, "STATES_NONSENSE.so: beamgyro_plugin_training()"));
}

TEST(LibraryCompensator, ASignalThatTheRunLacksIsNamed) {
  const auto library = faulty_plugin("WANTS_MORE");
  const Recording run = tested_run();
  EXPECT_TRUE(
      holds(rejection([&] { library->answer(run); }), "magnetic_field"));
}

TEST(LibraryCompensator, LeavesNoDescriptorAndNoProcess) {
  const auto descriptors = [] {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
  };
  const auto before = descriptors();
  for (const char* name : {"NONE", "CRASHES", "EXITS"})
    faulty_plugin(name)->answer(tested_run());
  EXPECT_EQ(descriptors(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // ECHILD: none is left
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace beamgyro::internal::library_test
