// SPDX-License-Identifier: MIT
#include "validation/external/conversation.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "validation/external/answering.h"
#include "validation/external/error_text.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kSentBytes = 1 << 16;      // made ready at a time
constexpr std::size_t kLongestAnswer = 1 << 16;  // bytes
constexpr std::size_t kQuoted = 40;              // characters of an answer

// A place among the samples of all stretches.
class Place {
 public:
  explicit Place(std::span<const AskedStretch> stretches)
      : stretches_(stretches) {
    if (!done()) sample_ = stretches_[0].samples.begin;
  }
  bool done() const { return stretch_ == stretches_.size(); }
  bool at_start() const { return sample_ == stretch().samples.begin; }
  const AskedStretch& stretch() const { return stretches_[stretch_]; }
  std::size_t sample() const { return sample_; }
  void advance() {
    if (++sample_ < stretch().samples.end) return;
    passed_ += duration_at(sample_ - 1);
    ++stretch_;
    sample_ = done() ? sample_ - 1 : stretch().samples.begin;
  }
  /// The stretch and sample here, or at the end the last ones.
  const AskedStretch& last_stretch() const {
    return stretches_[std::min(stretch_, stretches_.size() - 1)];
  }
  /// Time from the first sample [s], without what lies between stretches.
  double time() const {
    return passed_ + (done() ? 0.0 : duration_at(sample_));
  }

 private:
  double duration_at(std::size_t sample) const {
    const std::vector<double>& time = stretch().run->time;
    return time[sample] - time[stretch().samples.begin];
  }

  std::span<const AskedStretch> stretches_;
  std::size_t stretch_ = 0, sample_ = 0;
  double passed_ = 0.0;
};

class Conversation {
 public:
  Conversation(ChildProcess& process, AnswerLanguage& language,
               const std::vector<AskedStretch>& stretches,
               const ProcessLimits& limits)
      : process_(process),
        language_(language),
        limits_(limits),
        sent_(stretches),
        answered_(stretches) {}

  bool run();

 private:
  void prepare();
  void exchange();
  void take_answers(bool at_end);
  void check_time();
  void close_pipes();
  void conclude();
  double taken_time() const;
  std::string place_words() const;
  void fail(AnswerFault fault, std::string words);

  ChildProcess& process_;
  AnswerLanguage& language_;
  const ProcessLimits& limits_;
  Place sent_, answered_;
  std::string sending_, received_, error_;
  std::size_t written_ = 0;  // bytes of sending_
  std::size_t sent_bytes_ = 0;
  Stopwatch whole_, since_progress_;
  bool failed_ = false, ended_ = false;
};

bool Conversation::run() {
  const NoBrokenPipeSignal no_signal;
  while (!failed_ && (process_.output() || process_.error())) {
    prepare();
    exchange();
    take_answers(!process_.output());
    check_time();
  }
  if (!failed_) conclude();
  return !failed_;
}

// Makes bytes ready to be sent; closes the input after the last.
void Conversation::prepare() {
  if (!process_.input()) return;
  if (written_ == sending_.size()) {
    sending_.clear();
    written_ = 0;
  }
  const bool refills = sending_.empty();
  while (refills && !sent_.done() && sending_.size() < kSentBytes) {
    if (sent_.at_start()) language_.start(sent_.stretch(), sending_);
    language_.sample(sent_.sample(), sending_);
    sent_.advance();
  }
  if (refills) sent_bytes_ += sending_.size();
  if (sending_.empty()) process_.input().reset();
}

void Conversation::exchange() {
  const auto entry = [](const std::optional<OpenFile>& file, short events) {
    return pollfd{file ? file->descriptor() : -1, events, 0};
  };
  std::array<pollfd, 3> waits = {entry(process_.input(), POLLOUT),
                                 entry(process_.output(), POLLIN),
                                 entry(process_.error(), POLLIN)};
  const double left = limits_.stall - since_progress_.seconds();
  const int longest = static_cast<int>(
      std::clamp(std::ceil(1e3 * std::min(left, 1.0)), 0.0, 1e3));
  if (::poll(waits.data(), waits.size(), longest) <= 0) return;
  bool progress = false;
  if (waits[0].revents != 0) {
    // A process that reads no more is judged by what it answered.
    const std::size_t taken = write_available(
        process_.input(), std::string_view(sending_).substr(written_));
    written_ += taken;
    progress = taken > 0;
  }
  if (waits[1].revents != 0 && read_available(process_.output(), received_))
    progress = true;
  if (waits[2].revents != 0) read_available(process_.error(), error_);
  keep_tail(error_);
  if (progress) since_progress_ = Stopwatch();
}

void Conversation::take_answers(bool at_end) {
  std::string_view bytes = received_;
  while (!failed_) {
    const std::optional<WrittenAnswer> written =
        language_.answer(bytes, at_end);
    if (!written) break;
    if (answered_.done()) {
      fail(AnswerFault::kTooMany, "gave more answers than samples");
      break;
    }
    Answer& answer = *answered_.stretch().answer;
    const std::size_t k = answered_.sample();
    if (written->rate)
      answer.rate[k] = *written->rate;
    else if (!has_fault(answer, AnswerFault::kNotANumber))
      answer.faults.push_back(
          {AnswerFault::kNotANumber, k,
           fmt::format("answered \"{}\", which is no number, to {}",
                       written->text.substr(0, kQuoted), place_words())});
    answered_.advance();
  }
  received_.erase(0, received_.size() - bytes.size());
  if (!failed_ && received_.size() > kLongestAnswer)
    fail(AnswerFault::kNotANumber,
         fmt::format("answered \"{}...\", a line without end, to {}",
                     received_.substr(0, kQuoted), place_words()));
}

std::string Conversation::place_words() const {
  return answered_.done()
             ? "the end"
             : sample_words(*answered_.stretch().run, answered_.sample());
}

// Time of the samples that the process has read [s], by their share of bytes:
// the rest waits here or in the pipe.
double Conversation::taken_time() const {
  int waiting = 0;
  if (!process_.input() ||
      ::ioctl(process_.input()->descriptor(), FIONREAD, &waiting) != 0)
    return sent_.time();
  const double all = static_cast<double>(sent_bytes_);
  const double left = static_cast<double>(sending_.size() - written_) + waiting;
  return sent_.time() * (1.0 - left / all);
}

void Conversation::close_pipes() {
  process_.output().reset();
  process_.error().reset();
}

void Conversation::check_time() {
  if (failed_ || (!process_.output() && !process_.error())) return;
  // A process that it left behind may hold the pipes open. What it wrote before
  // its end is read once more.
  if (answered_.done() && process_.wait(0.0)) {
    if (ended_) close_pipes();
    ended_ = true;
    return;
  }
  if (since_progress_.seconds() > limits_.stall) {
    if (!process_.wait(0.0)) {
      fail(AnswerFault::kTimedOut,
           fmt::format("hung at {}: took no sample and gave no answer for "
                       "{:.3g} s",
                       place_words(), since_progress_.seconds()));
    } else {
      close_pipes();
    }
  } else if (whole_.seconds() > limits_.stall + taken_time()) {
    fail(AnswerFault::kTooSlow,
         fmt::format("slower than real time: stopped after {:.3g} s at {}",
                     whole_.seconds(), place_words()));
  }
}

void Conversation::conclude() {
  const std::optional<ProcessEnd> end = process_.wait(limits_.stall);
  if (!end) {
    fail(AnswerFault::kTimedOut,
         fmt::format("hung after its last answer for {:.3g} s", limits_.stall));
    return;
  }
  if (const auto fault = fault_of_end(*end, error_)) {
    fail(fault->fault, fmt::format("{} at {}{}", fault->words, place_words(),
                                   last_words(error_)));
  } else if (!answered_.done()) {
    fail(AnswerFault::kTooFew,
         fmt::format("gave fewer answers than samples: none to {} and what "
                     "follows{}",
                     place_words(), last_words(error_)));
  }
}

void Conversation::fail(AnswerFault fault, std::string words) {
  failed_ = true;
  const AskedStretch& at = answered_.last_stretch();
  const std::size_t sample =
      answered_.done() ? at.samples.end - 1 : answered_.sample();
  at.answer->faults.push_back({fault, sample, std::move(words)});
}

}  // namespace

std::vector<AskedStretch> asked_stretches(const Recording& run,
                                          Answer& answer) {
  answer.rate.assign(run.time.size(), NAN);
  std::vector<AskedStretch> stretches;
  for (const SampleRange& samples : powered_stretches(run))
    stretches.push_back({&run, &answer, samples});
  return stretches;
}

bool converse(ChildProcess& process, AnswerLanguage& language,
              const std::vector<AskedStretch>& stretches,
              const ProcessLimits& limits) {
  if (stretches.empty()) return true;
  return Conversation(process, language, stretches, limits).run();
}

}  // namespace beamgyro::internal
