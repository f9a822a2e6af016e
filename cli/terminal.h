// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro {

// Control characters in a printed text are replaced by \xNN.

/// Switches notes and progress off or on. Errors are always printed.
void set_quiet(bool quiet);

/// Prints a result on standard output. Throws std::runtime_error when it cannot
/// be written (a full disk, a closed pipe).
void print_result(std::string_view text);

/// Prints one line on standard error.
void print_note(std::string_view text);
void print_warning(std::string_view text);
void print_error(std::string_view text);

/// Keeps a warning until print_kept_warnings(), which prints each once. A
/// command that fails prints its error only.
void keep_warning(const std::string& text);
void print_kept_warnings();

/// Returns whether a line of progress may be drawn: standard error is a
/// terminal.
bool shows_progress();

/// Replaces the line of progress on standard error. An empty text clears it.
void print_progress(std::string_view text);

}  // namespace beamgyro
