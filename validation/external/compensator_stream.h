// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/recording/recording.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// The answer to a sample.
struct StreamAnswer {
  double rate;  // [deg/s]; NaN where unpowered or skipped
  // [deg/s], 1-sigma of its bias; NaN where the rate is, or not stated
  double sigma = std::numeric_limits<double>::quiet_NaN();
};

/// A compensator that answers samples as they come, for as long as they come.
class CompensatorStream {
 public:
  virtual ~CompensatorStream() = default;

  /// Takes the next sample: a recording of one, always with the same columns.
  /// Throws std::invalid_argument when it lacks a variable.
  virtual void take(const Recording& sample) = 0;

  /// Passes over a sample that cannot be read: its answer is NaN, and the
  /// compensator does not see it.
  virtual void skip() = 0;

  /// No more samples follow: waits for the answers that are missing.
  virtual void finish() = 0;

  /// Returns the descriptor that answers come from, or -1 when they are there
  /// after take().
  virtual int descriptor() const { return -1; }

  /// Takes answers that have come, and sees whether the process still works.
  virtual void collect() {}

  /// Returns whether its answers have a sigma.
  virtual bool states_sigma() const { return false; }

  /// Returns the answers that are there, in the order of the samples, and
  /// forgets them.
  std::vector<StreamAnswer> answers() { return std::exchange(answers_, {}); }

  /// What is wrong with the compensator; it takes no more samples then.
  const std::optional<SeenFault>& fault() const { return fault_; }

 protected:
  std::vector<StreamAnswer> answers_;
  std::optional<SeenFault> fault_;
};

/// Opens a compensator as open_tested_compensator() does. A library is told
/// `period` [s] at each power-on; without one that is the step between the
/// first two samples, and the first answer comes with the second sample.
std::unique_ptr<CompensatorStream> open_compensator_stream(
    const std::string& argument, const ProcessLimits& limits,
    std::optional<double> period);

}  // namespace beamgyro::internal
