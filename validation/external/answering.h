// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Measures wall clock.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Returns "sample 12 (1.2 s)", as faults name a place.
std::string sample_words(const Recording& run, std::size_t sample);

bool has_fault(const Answer& answer, AnswerFault fault);

/// Adds kNotFinite when a powered sample was answered with NaN or infinity.
/// Unanswered samples do not count when `answer` has a fault already.
void add_fault_of_values(const Recording& run, Answer& answer);

/// Adds kTooSlow when the answer took longer than the run, which has two
/// samples or more.
void add_fault_of_speed(const Recording& run, Answer& answer);

/// Returns the time from the first to the last sample, with the usual step [s].
double duration_with_last_sample(const Recording& run);

}  // namespace beamgyro::internal
