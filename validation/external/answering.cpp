// SPDX-License-Identifier: MIT
#include "validation/external/answering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {

std::string sample_words(const Recording& run, std::size_t sample) {
  return fmt::format("sample {} ({:.6g} s)", sample, run.time[sample]);
}

bool has_fault(const Answer& answer, AnswerFault fault) {
  return std::ranges::find(answer.faults, fault, &SeenFault::fault) !=
         answer.faults.end();
}

void add_fault_of_values(const Recording& run, Answer& answer) {
  if (!answer.faults.empty()) return;
  std::size_t first = 0, count = 0, powered = 0;
  for (std::size_t k = run.time.size(); k-- > 0;) {
    if ((run.status[k] & kUnpowered) != 0) continue;
    ++powered;
    if (std::isfinite(answer.rate[k])) continue;
    ++count;
    first = k;
  }
  if (count == 0) return;
  answer.faults.push_back(
      {AnswerFault::kNotFinite, first,
       fmt::format("answered {} at {}; {} of {} answers are not finite",
                   answer.rate[first], sample_words(run, first), count,
                   powered)});
}

double duration_with_last_sample(const Recording& run) {
  if (run.time.empty()) return 0.0;
  return run.time.back() - run.time.front() + usual_step(run);
}

void add_fault_of_speed(const Recording& run, Answer& answer) {
  if (run.time.size() < 2) return;  // a lone sample tells no duration
  const double duration = duration_with_last_sample(run);
  if (answer.seconds <= duration || has_fault(answer, AnswerFault::kTimedOut) ||
      has_fault(answer, AnswerFault::kStopped))
    return;
  // Without the time it took, so that the same inputs give the same words.
  answer.faults.push_back(
      {AnswerFault::kTooSlow, 0,
       fmt::format("slower than real time, {:.3g} s a sample",
                   duration / static_cast<double>(run.time.size()))});
}

}  // namespace beamgyro::internal
