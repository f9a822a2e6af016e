// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro {

// Whatever is printed, no control character of a text reaches the terminal: it
// is shown as \xNN.

/// No notes and no progress after this; errors stay.
void set_quiet(bool quiet);

/// A result, on standard output. Throws std::runtime_error when it cannot be
/// written (a full disk, a closed pipe).
void print_result(std::string_view text);

/// One line of side information on standard error.
void print_note(std::string_view text);
void print_warning(std::string_view text);
void print_error(std::string_view text);

/// Keeps a warning until print_kept_warnings(), which prints each once: of a
/// command that fails, the error is all there is to say.
void keep_warning(const std::string& text);
void print_kept_warnings();

/// Whether a line that changes may be drawn: standard error is a terminal.
bool shows_progress();

/// Replaces the line of progress on standard error; an empty text clears it.
void print_progress(std::string_view text);

}  // namespace beamgyro
