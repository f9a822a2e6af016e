// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro {

/// Keeps the end of what a process wrote on standard error.
void keep_tail(std::string& text);

/// Returns its last line as "; it wrote: LINE", or nothing.
std::string last_words(const std::string& text);

/// Returns whether it says that memory was refused: as C, C++, Python, Java and
/// shells say it.
bool tells_of_no_memory(const std::string& text);

}  // namespace beamgyro
