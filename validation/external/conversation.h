// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "validation/external/child_process.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Powered samples of a run from a power-on to the next loss of power, and
/// where the answers to them go.
struct AskedStretch {
  const Recording* run = nullptr;
  Answer* answer = nullptr;
  SampleRange samples{};
};

/// Returns the powered stretches of a run, and prepares its answer.
std::vector<AskedStretch> asked_stretches(const Recording& run, Answer& answer);

/// What a process wrote as one answer.
struct WrittenAnswer {
  std::optional<double> rate;  // nothing: no number
  std::string text;            // then
};

/// How samples and answers are written to and by a process.
class AnswerLanguage {
 public:
  virtual ~AnswerLanguage() = default;
  /// Appends what comes before the samples of a stretch.
  virtual void start(const AskedStretch& stretch, std::string& bytes) = 0;
  /// Appends sample k of the run of the last stretch.
  virtual void sample(std::size_t k, std::string& bytes) = 0;
  /// Removes one answer from the front of `bytes`. Returns nothing when more
  /// bytes are needed.
  virtual std::optional<WrittenAnswer> answer(std::string_view& bytes,
                                              bool at_end) = 0;
};

/// Sends the stretches to a process, one after the other, and takes its
/// answers, at the same time: it does not matter how the process buffers.
/// Returns false when the process cannot be asked more; the fault is in the
/// answer of the first stretch that is not answered.
bool converse(ChildProcess& process, AnswerLanguage& language,
              const std::vector<AskedStretch>& stretches,
              const ProcessLimits& limits);

}  // namespace beamgyro::internal
