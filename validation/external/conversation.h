// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "validation/external/answering.h"
#include "validation/external/child_process.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// What a process wrote as one answer.
struct WrittenAnswer {
  std::optional<double> rate;  // nothing: no number
  std::string text;            // then
};

/// How samples and answers are written to and by a process.
class AnswerLanguage {
 public:
  virtual ~AnswerLanguage() = default;
  /// Appends what comes before the powered samples of a run, which it keeps,
  /// `period` [s] apart.
  virtual void start(const Recording& run, double period,
                     std::string& bytes) = 0;
  /// Appends sample k of that run.
  virtual void sample(std::size_t k, std::string& bytes) = 0;
  /// Removes one answer from the front of `bytes`. Returns nothing when more
  /// bytes are needed.
  virtual std::optional<WrittenAnswer> answer(std::string_view& bytes,
                                              bool at_end) = 0;
};

/// How a process is started and spoken to that answers samples.
struct AnsweringProcess {
  ProcessStart start;
  std::unique_ptr<AnswerLanguage> language;
  bool answers_at_once;  // before it reads the next sample
};

/// Speaks with a process: sends it samples and takes its answers, at the same
/// time, so that it does not matter how the process buffers.
class Conversation {
 public:
  /// `place` returns words for the sample of an answer, counted from 0. The
  /// process fails when it does nothing that is expected of it for `stall` [s].
  Conversation(const ProcessStart& start, AnswerLanguage& language,
               double stall, std::function<std::string(std::size_t)> place)
      : process_(start),
        language_(language),
        stall_(stall),
        place_(std::move(place)) {}

  /// Expects more answers.
  void expect(std::size_t answers);
  /// Where the bytes of samples are appended.
  std::string& queue() { return queue_; }
  /// Sends the queue. With `time`, that of all samples so far [s], the process
  /// fails when it is slower than real time.
  void send(std::optional<double> time = {});
  /// Sends no more, waits for the answers that are missing and for the end.
  void finish();
  /// Sends and takes what can be, and waits for that at most `longest` [s].
  /// Nothing is expected of the process unless `owed`.
  void turn(double longest, bool owed);

  bool complete() const { return answered_ == expected_; }
  /// Whether it takes samples.
  bool listens() { return !failed_ && process_.input(); }
  /// Returns the descriptor that answers come from; -1: none will come.
  int descriptor();
  /// Returns the answers since the last call, NaN for what is no number.
  std::vector<double> answers() { return std::exchange(answers_, {}); }
  /// Returns what is wrong, with the number of the answer as the sample.
  const std::vector<SeenFault>& faults() const { return faults_; }
  /// Whether one of them ended the conversation.
  bool failed() const { return failed_; }

 private:
  void exchange(double longest);
  void take_answers();
  void close_pipes();
  double taken_time();
  std::string place() const { return place_(answered_); }
  void fail(AnswerFault fault, std::string words);

  ChildProcess process_;
  AnswerLanguage& language_;
  double stall_;  // [s]
  std::function<std::string(std::size_t)> place_;
  std::string queue_, received_, error_;
  std::size_t written_ = 0;                  // bytes of queue_
  std::size_t sent_ = 0;                     // bytes, with queue_
  std::size_t expected_ = 0, answered_ = 0;  // answers
  std::vector<double> answers_;
  std::vector<SeenFault> faults_;
  std::optional<double> time_;  // [s]
  Stopwatch whole_, since_progress_;
  bool failed_ = false, ended_ = false;
};

/// Powered samples of a run from a power-on to the next loss of power, and
/// where the answers to them go.
struct AskedStretch {
  const Recording* run = nullptr;
  Answer* answer = nullptr;
  SampleRange samples{};
};

/// Returns the powered stretches of a run, and prepares its answer.
std::vector<AskedStretch> asked_stretches(const Recording& run, Answer& answer);

/// Starts a process and asks it for the answers to the stretches, one after the
/// other. Returns false when it could not be asked for all; the fault is in the
/// answer of the first stretch that is not answered.
bool converse(const ProcessStart& start, AnswerLanguage& language,
              const std::vector<AskedStretch>& stretches,
              const ProcessLimits& limits);

}  // namespace beamgyro::internal
