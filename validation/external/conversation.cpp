// SPDX-License-Identifier: MIT
#include "validation/external/conversation.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>

#include "config/cut_text.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kSentBytes = 1 << 16;      // made ready at a time
constexpr std::size_t kLongestAnswer = 1 << 16;  // bytes
constexpr std::size_t kTail = 4096;              // bytes of standard error
constexpr std::size_t kQuoted = 40;              // bytes of an answer

// Whether it says that memory was refused: as C, C++, Python, Java and shells
// say it.
bool tells_of_no_memory(const std::string& text) {
  std::string lower = text;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  for (const char* words :
       {"out of memory", "memoryerror", "bad_alloc", "outofmemory",
        "cannot allocate memory", "memory allocation"})
    if (lower.find(words) != lower.npos) return true;
  return false;
}

// Returns sample n of all stretches, as a stretch of one; the last one behind
// the end.
AskedStretch sample_of(std::span<const AskedStretch> stretches, std::size_t n) {
  for (const AskedStretch& stretch : stretches) {
    const std::size_t k = stretch.samples.begin + n;
    if (n < stretch.samples.size())
      return {stretch.run, stretch.answer, {k, k + 1}};
    n -= stretch.samples.size();
  }
  const AskedStretch& last = stretches.back();
  return {last.run, last.answer, {last.samples.end - 1, last.samples.end}};
}

}  // namespace

void Conversation::expect(std::size_t answers) {
  if (complete()) since_progress_ = Stopwatch();
  expected_ += answers;
}

void Conversation::send(std::optional<double> time) {
  sent_ += queue_.size();
  time_ = time;
  while (listens() && written_ < queue_.size()) turn(1.0, true);
  queue_.clear();
  written_ = 0;
}

void Conversation::finish() {
  process_.input().reset();
  since_progress_ = Stopwatch();
  while (!failed_ && (process_.output() || process_.error())) turn(1.0, true);
  if (failed_) return;
  const std::optional<ProcessEnd> end = process_.wait(stall_);
  const bool no_memory = tells_of_no_memory(error_);
  if (!end)
    fail(AnswerFault::kTimedOut,
         fmt::format("hung after its last answer for {:.3g} s", stall_));
  else if (end->status != 0 || end->signal != 0)
    fail(no_memory ? AnswerFault::kOutOfMemory : AnswerFault::kCrashed,
         fmt::format("{}{} at {}{}", no_memory ? "ran out of memory: " : "",
                     end_words(*end), place(), last_words(error_)));
  else if (!complete())
    fail(AnswerFault::kTooFew,
         fmt::format("gave fewer answers than samples: none to {} and what "
                     "follows{}",
                     place(), last_words(error_)));
}

int Conversation::descriptor() {
  return process_.output() ? process_.output()->descriptor() : -1;
}

void Conversation::exchange(double longest) {
  const auto entry = [](const std::optional<OpenFile>& file, short events) {
    return pollfd{file ? file->descriptor() : -1, events, 0};
  };
  std::array<pollfd, 3> waits = {entry(process_.input(), POLLOUT),
                                 entry(process_.output(), POLLIN),
                                 entry(process_.error(), POLLIN)};
  if (written_ == queue_.size()) waits[0].fd = -1;
  const double left = stall_ - since_progress_.seconds();
  const int milliseconds =
      static_cast<int>(std::ceil(1e3 * std::clamp(left, 0.0, longest)));
  if (::poll(waits.data(), waits.size(), milliseconds) <= 0) return;
  bool progress = false;
  if (waits[0].revents != 0) {
    // A process that reads no more is judged by what it answered.
    const NoBrokenPipeSignal no_signal;
    const std::size_t taken = write_available(
        process_.input(), std::string_view(queue_).substr(written_));
    written_ += taken;
    progress = taken > 0;
  }
  if (waits[1].revents != 0 && read_available(process_.output(), received_))
    progress = true;
  if (waits[2].revents != 0) read_available(process_.error(), error_);
  if (error_.size() > 2 * kTail) error_.erase(0, error_.size() - kTail);
  if (progress) since_progress_ = Stopwatch();
}

void Conversation::take_answers() {
  std::string_view bytes = received_;
  while (!failed_) {
    const std::optional<WrittenAnswer> written =
        language_.answer(bytes, !process_.output());
    if (!written) break;
    if (complete()) {
      fail(AnswerFault::kTooMany, "gave more answers than samples");
      break;
    }
    if (!written->rate && faults_.empty())
      faults_.push_back(
          {AnswerFault::kNotANumber, answered_,
           fmt::format("answered \"{}\", which is no number, to {}",
                       cut_text(written->text, kQuoted), place())});
    answers_.push_back(written->rate.value_or(NAN));
    ++answered_;
  }
  received_.erase(0, received_.size() - bytes.size());
  if (!failed_ && received_.size() > kLongestAnswer)
    fail(AnswerFault::kNotANumber,
         fmt::format("answered \"{}...\", a line without end, to {}",
                     cut_text(received_, kQuoted), place()));
}

// Time of the samples that the process has read [s], by their share of bytes:
// the rest waits here or in the pipe.
double Conversation::taken_time() {
  int waiting = 0;
  if (!process_.input() ||
      ::ioctl(process_.input()->descriptor(), FIONREAD, &waiting) != 0)
    return *time_;
  const double left = static_cast<double>(queue_.size() - written_) + waiting;
  return *time_ * (1.0 - left / static_cast<double>(sent_));
}

void Conversation::close_pipes() {
  for (auto* pipe : {&process_.input(), &process_.output(), &process_.error()})
    pipe->reset();
}

void Conversation::turn(double longest, bool owed) {
  exchange(longest);
  take_answers();
  if (failed_ || (!process_.output() && !process_.error())) return;
  // A process that it left behind may hold the pipes open. What it wrote before
  // its end is read once more.
  if (complete() && process_.wait(0.0)) {
    if (std::exchange(ended_, true)) close_pipes();
  } else if (owed && since_progress_.seconds() > stall_) {
    if (process_.wait(0.0)) return close_pipes();
    fail(AnswerFault::kTimedOut,
         fmt::format("hung at {}: took no sample and gave no answer for "
                     "{:.3g} s",
                     place(), since_progress_.seconds()));
  } else if (time_ && whole_.seconds() > stall_ + taken_time()) {
    fail(AnswerFault::kStopped,
         fmt::format("slower than real time: stopped after {:.3g} s at {}",
                     whole_.seconds(), place()));
  }
}

void Conversation::fail(AnswerFault fault, std::string words) {
  failed_ = true;
  faults_.push_back({fault, answered_, std::move(words)});
}

std::vector<AskedStretch> asked_stretches(const Recording& run,
                                          Answer& answer) {
  answer.rate.assign(run.time.size(), NAN);
  std::vector<AskedStretch> stretches;
  for (const SampleRange& samples : powered_stretches(run))
    stretches.push_back({&run, &answer, samples});
  return stretches;
}

bool converse(const ProcessStart& start, AnswerLanguage& language,
              const std::vector<AskedStretch>& stretches,
              const ProcessLimits& limits) {
  if (stretches.empty()) return true;
  std::size_t all = 0;
  for (const AskedStretch& stretch : stretches) all += stretch.samples.size();
  Conversation process(start, language, limits.stall, [&](std::size_t n) {
    const AskedStretch at = sample_of(stretches, n);
    return n == all ? "the end" : sample_words(*at.run, at.samples.begin);
  });
  process.expect(all);
  double time = 0.0;  // [s], without what lies between stretches
  for (const AskedStretch& stretch : stretches) {
    if (!process.listens()) break;
    language.start(*stretch.run, usual_step(*stretch.run), process.queue());
    const double* const times = stretch.run->time.data();
    const auto [begin, end] = stretch.samples;
    for (std::size_t k = begin; k < end && process.listens(); ++k) {
      language.sample(k, process.queue());
      if (process.queue().size() >= kSentBytes)
        process.send(time + times[k] - times[begin]);
    }
    time += times[end - 1] - times[begin];
  }
  process.send(time);
  if (!process.failed()) process.finish();
  const std::vector<double> rates = process.answers();
  std::span<const double> left = rates;
  for (const auto& [run, answer, samples] : stretches) {
    const auto part = left.first(std::min(left.size(), samples.size()));
    std::ranges::copy(part, answer->rate.data() + samples.begin);
    left = left.subspan(part.size());
  }
  for (const SeenFault& seen : process.faults())
    if (const AskedStretch at = sample_of(stretches, seen.sample);
        !has_fault(*at.answer, seen.fault))
      at.answer->faults.push_back({seen.fault, at.samples.begin, seen.words});
  return !process.failed();
}

}  // namespace beamgyro::internal
