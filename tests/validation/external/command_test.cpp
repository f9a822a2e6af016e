// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <cmath>
#include <fstream>

#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"
#include "tests/validation/external/tested_run.h"
#include "validation/external/answer_checks.h"
#include "validation/external/answering.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal::command_test {
namespace {

using enum AnswerFault;

// A Python program that corrects 0.01 deg/s/K. {} are what it does before the
// first sample, what answers rate r of sample k, and what it does at the end.
constexpr const char* kProgram = R"(
import sys, time
names = sys.stdin.readline().strip().split(",")
R, T = names.index("rate"), names.index("temperature")
{}
for k, line in enumerate(sys.stdin):
    values = line.split(",")
    r = float(values[R]) - 0.01 * float(values[T])
    {}
{}
)";

class CommandCompensator : public DirectoryFixture {
 protected:
  std::shared_ptr<const TestedCompensator> program(
      const std::string& answer = "print(repr(r))",
      const std::string& before = "", const std::string& at_end = "",
      const std::string& options = "") const {
    std::ofstream(directory / "a program.py")
        << fmt::format(fmt::runtime(kProgram), before, answer, at_end);
    return command(fmt::format("/usr/bin/python3 {} '{}'", options,
                               (directory / "a program.py").string()));
  }
  std::shared_ptr<const TestedCompensator> command(
      const std::string& text) const {
    return open_tested_compensator("cmd:" + text, limits);
  }

  ProcessLimits limits = test_limits();
};

void expect_right_answers(const TestedCompensator& compensator) {
  const Recording run = tested_run();
  const Answer answer = compensator.answer(run);
  EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
  const auto& rate = column_values(run, "rate");
  const auto& temperature = column_values(run, "temperature");
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    if ((run.status[k] & kUnpowered) != 0)
      ASSERT_TRUE(std::isnan(answer.rate[k]));
    else
      ASSERT_EQ(answer.rate[k], rate[k] - 0.01 * temperature[k]);
  }
}

AnswerFault fault_of(const TestedCompensator& compensator) {
  return only_fault(compensator).fault;
}

}  // namespace

TEST_F(CommandCompensator, AnswersToTheLastBitHoweverItBuffers) {
  expect_right_answers(*program());                          // blocks of 8 KiB
  expect_right_answers(*program("print(r)", "", "", "-u"));  // lines
  expect_right_answers(
      *program("all.append(r)", "all = []", "print(*all, sep='\\n')"));
  expect_right_answers(*program("print(r, end='\\r\\n')"));
}

TEST_F(CommandCompensator, IsStartedAnewAtEachPowerOn) {
  const auto counts = program("print(k)");
  const Answer answer = counts->answer(tested_run());
  EXPECT_EQ(answer.rate[0], 0.0);
  EXPECT_EQ(answer.rate[899], 899.0);
  EXPECT_EQ(answer.rate[950], 0.0);
}

TEST_F(CommandCompensator, IsGivenWhatIsMeasuredAndNothingElse) {
  const auto counts = program("print(len(values))",
                              "assert names == ['time', 'output', 'rate', "
                              "'temperature', 'status']");
  const Answer answer = counts->answer(tested_run());
  EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
  EXPECT_EQ(answer.rate[0], 5.0);
}

TEST_F(CommandCompensator, ACrashIsReportedWithItsLastWords) {
  const SeenFault raised =
      only_fault(*program("print(r, flush=True); 700 / (700 - k)"));
  EXPECT_EQ(raised.fault, kCrashed);
  EXPECT_EQ(raised.sample, 701u);
  EXPECT_TRUE(holds(raised.words, "ZeroDivisionError"));
  const SeenFault killed = only_fault(
      *program("print(r, flush=True); k == 700 and os.kill(os.getpid(), 11)",
               "import os"));
  EXPECT_EQ(killed.fault, kCrashed);
  EXPECT_TRUE(holds(killed.words, "signal 11, Segmentation fault"));
  EXPECT_EQ(fault_of(*command("beamgyro_no_such_program")), kCrashed);
  EXPECT_EQ(fault_of(*program("print(r)", "", "sys.exit(3)")), kCrashed);
}

TEST_F(CommandCompensator, AHangIsStoppedWithAllItsProcesses) {
  const Stopwatch watch;
  const SeenFault hang = only_fault(
      *program("print(r, flush=True); k == 700 and time.sleep(1000)"));
  EXPECT_EQ(hang.fault, kTimedOut);
  EXPECT_EQ(hang.sample, 701u);
  EXPECT_EQ(fault_of(*command("sleep 1000 | cat")), kTimedOut);
  EXPECT_EQ(fault_of(*program("print(r)", "",
                              "sys.stdout.close(); time.sleep(1000)")),
            kTimedOut);
  // A guard against a limit that does not hold; a busy machine stays far below.
  EXPECT_LT(watch.seconds(), 60.0 * test_limits().stall);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(CommandCompensator, AProcessLeftBehindHoldsNothingUp) {
  constexpr const char* kLeave =
      "import subprocess; subprocess.Popen(['sleep', '1000'])";
  expect_right_answers(*program("print(repr(r))", kLeave));
  EXPECT_EQ(fault_of(*program("k == 700 or print(r)", kLeave)), kTooFew);
}

TEST_F(CommandCompensator, TooMuchMemoryIsRefused) {
  limits.memory = std::size_t{512} << 20;
  const auto python = open_tested_compensator(
      "cmd:/usr/bin/python3 -c 'x = bytearray(1 << 30)'", limits);
  EXPECT_EQ(fault_of(*python), kOutOfMemory);
}

TEST_F(CommandCompensator, TooFewAndTooManyAnswersAreSaid) {
  const SeenFault few = only_fault(*program("k == 700 or print(r)"));
  EXPECT_EQ(few.fault, kTooFew);
  EXPECT_EQ(fault_of(*command("true")), kTooFew);
  EXPECT_EQ(fault_of(*command("head -n 3 | tail -n 1 | cut -d , -f 2")),
            kTooFew);
  EXPECT_EQ(fault_of(*program("print(r)", "", "print(0)")), kTooMany);
  EXPECT_EQ(fault_of(*command("yes 1")), kTooMany);
}

TEST_F(CommandCompensator, NonsenseIsQuoted) {
  const SeenFault word =
      only_fault(*program("print('ready' if k == 700 else r)"));
  EXPECT_EQ(word.fault, kNotANumber);
  EXPECT_EQ(word.sample, 700u);
  EXPECT_TRUE(holds(word.words, "\"ready\""));
  for (const char* line : {"''", "'1,5'", "'1 2'", "'0x1p3'", "'+-0.5'",
                           "'++1'", "'1e'", "'-'", "'1e999x'"})
    EXPECT_EQ(fault_of(*program(fmt::format("print({})", line))), kNotANumber)
        << line;
  EXPECT_EQ(fault_of(*command("tr -d '\\n' </dev/zero | tr '\\0' x")),
            kNotANumber);
}

TEST_F(CommandCompensator, OneNaNOfAHundredThousandAnswersIsFound) {
  const SeenFault nan = only_fault(*program("print('nan' if k == 700 else r)"),
                                   tested_run(1000.0));
  EXPECT_EQ(nan.fault, kNotFinite);
  EXPECT_EQ(nan.sample, 700u);
  EXPECT_EQ(fault_of(*program("print('-inf')")), kNotFinite);
}

TEST_F(CommandCompensator, NumbersBeyondTheRangeOfDoublesAreNumbers) {
  for (const char* line : {"1e309", "-1e999", "+123e307", "0.1e310", "inf"}) {
    const SeenFault seen = only_fault(
        *program(fmt::format("print('{}' if k == 700 else r)", line)));
    EXPECT_EQ(seen.fault, kNotFinite) << line;
    EXPECT_EQ(seen.sample, 700u);
  }
  for (const char* line :
       {"1e-400", "+0.001e-330", "-1e-999999999999999999999", "0e999"}) {
    const Answer answer =
        program(fmt::format("print('{}')", line))->answer(tested_run(0.1));
    EXPECT_TRUE(answer.faults.empty()) << line;
    EXPECT_EQ(answer.rate[0], 0.0);
  }
}

// The fortieth byte of the answer is within a letter of two.
TEST_F(CommandCompensator, NoLetterIsCutInAQuote) {
  std::string first = "a";
  for (int k = 0; k < 19; ++k) first += "ä";
  const SeenFault answer = only_fault(*program("print('a' + 'ä' * 40)"));
  EXPECT_TRUE(holds(answer.words, '"' + first + '"')) << answer.words;
  const SeenFault last =
      only_fault(*program("print(r)", "", "sys.exit('a' + 'ä' * 200)"));
  EXPECT_TRUE(last.words.ends_with("ä")) << last.words;
}

TEST_F(CommandCompensator, OneThatIsStoppedHasNotAnsweredEverySample) {
  const auto slow = program("time.sleep(0.1); print(r, flush=True)");
  const SeenFault seen = only_fault(*slow, tested_run(1.0));
  EXPECT_EQ(seen.fault, kStopped);
  EXPECT_TRUE(holds(seen.words, "slower than real time: stopped"));
}

TEST_F(CommandCompensator, SlowerThanRealTimeIsSaid) {
  const auto slow = program("time.sleep(0.012); print(r)");
  EXPECT_EQ(only_fault(*slow, tested_run(1.0)).fault, kTooSlow);
}

TEST_F(CommandCompensator, ALoneSampleIsNoSlowness) {
  const Recording lone = tested_run(0.01);
  ASSERT_EQ(lone.time.size(), 1U);
  const Answer answer = program()->answer(lone);
  EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
}

// The start of an interpreter, on a busy machine longer than a short run.
TEST_F(CommandCompensator, ALongStartIsNoSlowness) {
  const auto late = program("print(repr(r))", "time.sleep(1.5)");
  EXPECT_TRUE(late->answer(tested_run(1.0)).faults.empty());
}

TEST_F(CommandCompensator, PeekingOneSampleAheadIsFound) {
  const auto peeks = program("print(r) if k else None; last = r", "",
                             "print(last)");  // the answer of the next sample
  EXPECT_TRUE(peeks->answer(tested_run()).faults.empty());
  const auto seen = later_samples_used(*peeks, tested_run());
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->fault, kUsesLaterSamples);
  EXPECT_FALSE(state_kept_over_reset(*peeks, tested_run()));
  const auto mean = program("all.append(r)", "all = []",
                            "m = sum(all) / len(all)\n"
                            "for r in all: print(r - m)");
  EXPECT_TRUE(later_samples_used(*mean, tested_run()));
}

TEST_F(CommandCompensator, ACausalProgramHasNoFaultByComparison) {
  const auto filter = program("y += 0.1 * (r - y); print(y)", "y = 0.0");
  EXPECT_FALSE(later_samples_used(*filter, tested_run()));
  EXPECT_FALSE(state_kept_over_reset(*filter, tested_run()));
}

TEST_F(CommandCompensator, StateInAFileIsFound) {
  limits.isolation.highest_landlock = 0;
  const auto keeps = program(
      "print(r + before)",
      "import os, pathlib\n"
      "kept = pathlib.Path(__file__ + '.kept')\n"
      "before = 1e-9 * len(kept.read_text()) if kept.exists() else 0.0\n"
      "kept.write_text('x' * (int(before * 1e9) + 1))");
  const auto kept = state_kept_over_reset(*keeps, tested_run());
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->fault, kKeepsState);
}

TEST_F(CommandCompensator, AnEmptyCommandIsRefused) {
  EXPECT_TRUE(holds(rejection([this] { command(" "); }), "no command"));
}

TEST(FileCompensator, AnswersAsCompensate) {
  const FittedCompensator compensator = spline_compensator();
  const Recording run = tested_run();
  const auto file = tested(compensator);
  const Answer answer = file->answer(run);
  EXPECT_TRUE(answer.faults.empty());
  const Answer other{compensated_rate(compensator, run)};
  const AnswerDifference none = difference_of(answer, other);
  EXPECT_EQ(none.samples, 950u);
  EXPECT_EQ(none.largest, 0.0);
  EXPECT_FALSE(state_kept_over_reset(*file, run));
  EXPECT_FALSE(later_samples_used(*file, run));
}

TEST(AnswerDifference, IsTheLargestAndTheRms) {
  const Answer one{{1.0, 2.0, NAN, 4.0}}, other{{1.0, 2.5, 0.0, 3.0}};
  const AnswerDifference found = difference_of(one, other);
  EXPECT_EQ(found.samples, 3u);
  EXPECT_EQ(found.largest, 1.0);
  EXPECT_EQ(found.at, 3u);
  EXPECT_DOUBLE_EQ(found.rms, std::sqrt((0.25 + 1.0) / 3.0));
}

}  // namespace beamgyro::internal::command_test
