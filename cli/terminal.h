// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace beamgyro::internal {

// Control characters in a printed text are replaced by \xNN.

/// Switches notes and progress off or on. Errors are always printed.
void set_quiet(bool quiet);

/// Prints a result on standard output. Throws std::runtime_error when it cannot
/// be written (a full disk, a closed pipe).
void print_result(std::string_view text);

/// The same with bytes as they are.
void print_bytes(std::string_view bytes);

/// Prints one line on standard error.
void print_note(std::string_view text);
void print_warning(std::string_view text);
void print_error(std::string_view text);

/// Keeps a warning until print_kept_warnings(), which prints each once. A
/// command that fails prints its error only.
void keep_warning(const std::string& text);
void print_kept_warnings();

bool is_quiet();

/// Returns `text`, or its start and "..." if it is longer than `width` bytes.
std::string shortened(std::string_view text, std::size_t width);

/// Returns the width of the terminal that standard error is, or 80.
std::size_t terminal_width();

/// Returns whether a line of progress may be drawn: standard error is a
/// terminal.
bool shows_progress();

/// Replaces the line of progress on standard error. A text wider than the
/// terminal is cut off, an empty one clears the line. Lines that are printed
/// meanwhile stand above it.
void print_progress(std::string_view text);

/// What the user reads when he interrupts the command: what is kept and how to
/// go on. The text is copied, up to 500 bytes.
void set_interrupt_note(std::string_view text);

/// Removes the line of progress and prints the note of an interruption. May be
/// called from a signal handler.
void print_interrupted() noexcept;

}  // namespace beamgyro::internal
