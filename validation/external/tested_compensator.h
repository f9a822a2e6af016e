// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dataset/recording/recording.h"
#include "validation/external/isolation.h"

namespace beamgyro::internal {

struct Provenance;

/// What can be wrong with the way a compensator answers.
enum class AnswerFault {
  kCrashed,           // its process ended by a signal or with a status
  kTimedOut,          // neither took a sample nor answered for too long
  kOutOfMemory,       // it asked for more memory than allowed
  kTooFew,            // fewer answers than samples
  kTooMany,           // more answers than samples
  kNotANumber,        // an answer that is no number at all
  kNotFinite,         // NaN or infinity for a powered sample
  kKeepsState,        // another answer to the same run after a reset
  kUsesLaterSamples,  // an answer changes with a later sample
  kTooSlow,           // slower than real time
  kStopped,           // so slow that it was stopped before it had answered all
  kReported,          // reported by a class of the user's own
  kCount              // no fault: how many there are
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
  // [deg/s], 1-sigma of the bias of each; empty where it tells none.
  std::vector<double> sigma = {};
  std::vector<SeenFault> faults = {};
  std::size_t clamped = 0;  // samples outside what training saw, where known
  // Of wall clock, with the start of its processes; without it for a command
  // that would be slower than real time with it.
  double seconds = 0.0;
};

/// What a compensator may use that runs in a process of its own.
struct ProcessLimits {
  double stall = 10.0;  // [s], without taking a sample or giving an answer
  std::size_t memory = std::size_t{2} << 30;  // [bytes]; 0: no limit

  // The beamgyro program, which loads libraries and isolates commands in
  // processes of their own. Inside the program itself: /proc/self/exe. Without
  // it commands are not isolated.
  std::filesystem::path program = {};
  IsolationOptions isolation = {};
};

/// A compensator of any kind that is to be validated. It is given time and the
/// measured variables of the powered samples and nothing else. Every member may
/// be called from several threads at once.
class TestedCompensator {
 public:
  virtual ~TestedCompensator() = default;

  /// Returns the measured variables that it reads, as recordings name them. A
  /// command is given all that a recording has.
  virtual std::vector<std::string> inputs() const = 0;

  /// Returns its answers to runs that follow each other in one process, with a
  /// reset before each run and at each power-on within it. A fault of the
  /// compensator is reported in the answer concerned. Throws
  /// std::invalid_argument when a recording lacks one of inputs(), and
  /// std::runtime_error when the system refuses a process.
  virtual std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const = 0;

  /// Whether inputs() is what it reads, and not all that it may read.
  virtual bool states_inputs() const { return false; }

  /// Whether the seconds of its answers are its own, and not those of waiting
  /// for another thread that asks it.
  virtual bool is_timed() const { return true; }

  /// Returns what it states of its training, or a null pointer.
  virtual const Provenance* provenance() const { return nullptr; }

  /// Returns its answers to one run.
  Answer answer(const Recording& run) const {
    return std::move(answers({&run}).front());
  }
};

}  // namespace beamgyro::internal
