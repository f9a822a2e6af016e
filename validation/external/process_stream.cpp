// SPDX-License-Identifier: MIT
#include "validation/external/process_stream.h"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "validation/external/answering.h"
#include "validation/external/error_text.h"

namespace beamgyro::internal {
namespace {

class ProcessStream : public CompensatorStream {
 public:
  ProcessStream(AnsweringProcess answering, const ProcessLimits& limits,
                std::optional<double> period)
      : answering_(std::move(answering)), limits_(limits), period_(period) {}

  void take(const Recording& sample) override;
  void finish() override { end_stretch(); }
  int descriptor() const override;
  void collect() override;

 private:
  void start(const Recording& sample, double period);
  void send(const Recording& sample, bool starts);
  void exchange(short input_events, int longest);
  void take_answers(bool at_end);
  void end_stretch();
  void fail(AnswerFault fault, const std::string& words);
  std::string place() const { return fmt::format("sample {}", answered_); }

  AnsweringProcess answering_;
  ProcessLimits limits_;
  std::optional<double> period_;  // [s]
  std::unique_ptr<ChildProcess> process_;
  Recording row_;                   // what the language reads, one sample
  std::optional<Recording> first_;  // kept until the second one comes
  std::string received_, error_, sending_;
  std::size_t written_ = 0;               // bytes of sending_
  std::size_t asked_ = 0, answered_ = 0;  // samples
  Stopwatch since_progress_;
};

int ProcessStream::descriptor() const {
  return process_ && process_->output() ? process_->output()->descriptor() : -1;
}

void ProcessStream::take(const Recording& sample) {
  if (fault_) return;
  if ((sample.status[0] & kUnpowered) != 0) {
    end_stretch();
    answers_.push_back({NAN});
    ++asked_;
    ++answered_;
    return;
  }
  if (!process_ && !first_ && !period_) {
    first_ = sample;
    return;
  }
  if (first_) {
    const Recording first = *std::exchange(first_, std::nullopt);
    start(first, sample.time[0] - first.time[0]);
  } else if (!process_) {
    return start(sample, *period_);
  }
  send(sample, false);
}

// The language finds the period between two times, and keeps pointers to the
// columns.
void ProcessStream::start(const Recording& sample, double period) {
  process_ = std::make_unique<ChildProcess>(answering_.words);
  received_.clear();
  error_.clear();
  row_ = sample;
  row_.time.push_back(sample.time[0] + period);
  row_.status.push_back(0);
  for (Column& column : row_.columns) column.values.push_back(0.0);
  send(sample, true);
}

void ProcessStream::send(const Recording& sample, bool starts) {
  row_.time[0] = sample.time[0];
  row_.status[0] = sample.status[0];
  for (std::size_t i = 0; i < row_.columns.size(); ++i)
    row_.columns[i].values[0] = sample.columns[i].values[0];
  sending_.clear();
  written_ = 0;
  if (starts) answering_.language->start({&row_, nullptr, {0, 1}}, sending_);
  answering_.language->sample(0, sending_);
  if (asked_ == answered_) since_progress_ = Stopwatch();
  ++asked_;
  while (!fault_ && process_->input() && written_ < sending_.size()) {
    exchange(POLLOUT, 100);
    take_answers(false);
    if (since_progress_.seconds() > limits_.stall)
      fail(AnswerFault::kTimedOut,
           fmt::format("hung at {}: took no sample for {:.3g} s", place(),
                       since_progress_.seconds()));
  }
}

void ProcessStream::exchange(short input_events, int longest) {
  const auto entry = [](const std::optional<OpenFile>& file, short events) {
    return pollfd{file ? file->descriptor() : -1, events, 0};
  };
  std::array<pollfd, 3> waits = {entry(process_->input(), input_events),
                                 entry(process_->output(), POLLIN),
                                 entry(process_->error(), POLLIN)};
  if (input_events == 0) waits[0].fd = -1;
  if (::poll(waits.data(), waits.size(), longest) <= 0) return;
  if (waits[1].revents != 0 && read_available(process_->output(), received_))
    since_progress_ = Stopwatch();
  if (waits[2].revents != 0 && read_available(process_->error(), error_))
    since_progress_ = Stopwatch();
  keep_tail(error_);
  if (waits[0].revents == 0) return;
  const NoBrokenPipeSignal no_signal;
  const std::size_t taken = write_available(
      process_->input(), std::string_view(sending_).substr(written_));
  if (taken == 0) return;
  written_ += taken;
  since_progress_ = Stopwatch();
}

void ProcessStream::take_answers(bool at_end) {
  std::string_view bytes = received_;
  while (!fault_) {
    const auto written = answering_.language->answer(bytes, at_end);
    if (!written) break;
    if (answered_ == asked_)
      fail(AnswerFault::kTooMany, "gave more answers than samples");
    else if (!written->rate)
      fail(AnswerFault::kNotANumber,
           fmt::format("answered \"{}\", which is no number, to {}",
                       written->text.substr(0, 40), place()));
    if (fault_) break;
    answers_.push_back({*written->rate});
    ++answered_;
  }
  received_.erase(0, received_.size() - bytes.size());
}

void ProcessStream::collect() {
  if (!process_ || fault_) return;
  exchange(0, 0);
  take_answers(!process_->output());
  if (!fault_ && !process_->output()) return end_stretch();
  if (!fault_ && answering_.answers_at_once && asked_ > answered_ &&
      since_progress_.seconds() > limits_.stall)
    fail(AnswerFault::kTimedOut,
         fmt::format("hung at {}: gave no answer for {:.3g} s", place(),
                     since_progress_.seconds()));
}

// Power was lost, or the last sample was sent, or the process ended.
void ProcessStream::end_stretch() {
  if (first_ && !fault_) {
    const Recording only = *std::exchange(first_, std::nullopt);
    start(only, 1.0);  // no period is known
  }
  if (!process_ || fault_) return;
  process_->input().reset();
  since_progress_ = Stopwatch();
  while (!fault_ && (process_->output() || process_->error())) {
    exchange(0, 100);
    take_answers(!process_->output());
    if (since_progress_.seconds() > limits_.stall) break;
  }
  const auto end = fault_ ? std::nullopt : process_->wait(limits_.stall);
  if (fault_) return;
  if (!end)
    fail(AnswerFault::kTimedOut, fmt::format("hung at {}", place()));
  else if (const auto fault = fault_of_end(*end, error_))
    fail(fault->fault,
         fmt::format("{} at {}{}", fault->words, place(), last_words(error_)));
  else if (answered_ < asked_)
    fail(AnswerFault::kTooFew,
         fmt::format("gave fewer answers than samples: none to {} and what "
                     "follows{}",
                     place(), last_words(error_)));
  process_.reset();
}

void ProcessStream::fail(AnswerFault fault, const std::string& words) {
  fault_ = SeenFault{fault, answered_, words};
}

}  // namespace

std::unique_ptr<CompensatorStream> process_stream(
    AnsweringProcess answering, const ProcessLimits& limits,
    std::optional<double> period) {
  return std::make_unique<ProcessStream>(std::move(answering), limits, period);
}

}  // namespace beamgyro::internal
