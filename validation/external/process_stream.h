// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/external/compensator_stream.h"
#include "validation/external/conversation.h"

namespace beamgyro::internal {

/// How a process is started and spoken to that answers samples.
struct AnsweringProcess {
  std::vector<std::string> words;
  std::unique_ptr<AnswerLanguage> language;
  bool answers_at_once;  // before it reads the next sample
};

/// Returns a stream that starts the process at each power-on. Without a period
/// [s] it waits for the second sample to know it.
std::unique_ptr<CompensatorStream> process_stream(AnsweringProcess answering,
                                                  const ProcessLimits& limits,
                                                  std::optional<double> period);

}  // namespace beamgyro::internal
