// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "validation/external/child_process.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Keeps the end of what a process wrote on standard error.
void keep_tail(std::string& text);

/// Returns its last line as "; it wrote: LINE", or nothing.
std::string last_words(const std::string& text);

/// Returns whether it says that memory was refused: as C, C++, Python, Java and
/// shells say it.
bool tells_of_no_memory(const std::string& text);

/// Returns the fault of a process that did not end with status 0, and its words
/// without a place.
struct EndFault {
  AnswerFault fault;
  std::string words;
};
std::optional<EndFault> fault_of_end(const ProcessEnd& end,
                                     const std::string& error);

}  // namespace beamgyro::internal
