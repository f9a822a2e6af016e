// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro {

/// What can be wrong with the way a compensator answers.
enum class AnswerFault {
  kCrashed,           // the process that ran it ended by a signal or a status
  kTimedOut,          // no answer within the time allowed
  kOutOfMemory,       // it asked for more memory than allowed
  kTooFew,            // fewer answers than samples
  kTooMany,           // more answers than samples
  kNotANumber,        // an answer that is no number at all
  kNotFinite,         // NaN or infinity for a powered sample
  kKeepsState,        // another answer to the same run after a reset
  kUsesLaterSamples,  // an answer changes with a later sample
  kTooSlow,           // slower than real time
};

/// A fault that was seen, in words for the user.
struct SeenFault {
  AnswerFault fault;
  std::size_t sample;  // the first one concerned
  std::string words;
};

/// The answers of a compensator to one run.
struct Answer {
  std::vector<double> rate;  // [deg/s], one per time; NaN where none came
  std::vector<SeenFault> faults = {};
  std::size_t clamped = 0;  // samples outside what training saw, where known
  double seconds = 0.0;     // of wall clock
};

/// Limits for a compensator that runs in a process of its own.
struct ProcessLimits {
  double seconds_per_sample = 1e-3;           // [s], beside start_seconds
  double start_seconds = 10.0;                // [s]
  std::size_t memory = std::size_t{2} << 30;  // [bytes]
};

/// A compensator of any kind that is to be validated. It is given the measured
/// variables of a recording and nothing else. Every member may be called from
/// several threads at once.
class TestedCompensator {
 public:
  virtual ~TestedCompensator() = default;

  /// Returns the measured variables that it reads, as recordings name them.
  virtual std::vector<std::string> inputs() const = 0;

  /// Returns its answers to a run, from the state after a reset. A fault of
  /// the compensator is reported in the answer. Throws std::invalid_argument
  /// when the recording lacks one of inputs().
  virtual Answer answer(const Recording& run) const = 0;
};

/// Opens a compensator file (FILE.json), a shared library (FILE.so) with the
/// interface of beamgyro/plugin.h, or a command ("cmd:PROGRAM ARGS"). Throws
/// std::invalid_argument when it is none of them or cannot be read.
std::unique_ptr<TestedCompensator> open_tested_compensator(
    const std::string& argument, const ProcessLimits& limits = {});

}  // namespace beamgyro
