// SPDX-License-Identifier: MIT
#include "cli/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>

namespace beamgyro::internal {
namespace {

bool prints_errors_only = false;
std::set<std::string> kept_warnings;
constexpr std::string_view kClear = "\r\033[K";  // the line of the terminal
std::atomic<bool> progress_shown = false, interrupted = false;

// In storage that a signal handler may read at any moment.
std::array<char, 500> interrupt_note{};
std::atomic<std::size_t> interrupt_note_size = 0;

bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && !(no_colour && *no_colour) &&
         !(terminal && std::string_view(terminal) == "dumb");
}

/// Returns the length of the UTF-8 character at the start of `text`, or 0 when
/// there is none or it is a control character.
std::size_t shown_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  // Overlong forms, surrogates and values beyond Unicode are not characters.
  const std::size_t length = first >= 0xc2 && first <= 0xdf   ? 2
                             : first >= 0xe0 && first <= 0xef ? 3
                             : first >= 0xf0 && first <= 0xf4 ? 4
                                                              : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const unsigned second = byte(1);
  const bool is_wrong =
      (first == 0xc2 && second < 0xa0) || (first == 0xe0 && second < 0xa0) ||
      (first == 0xed && second > 0x9f) || (first == 0xf0 && second < 0x90) ||
      (first == 0xf4 && second > 0x8f);
  return is_wrong ? 0 : length;
}

/// Returns `text` with control characters and bytes that are not UTF-8 replaced
/// by \xNN, because texts come from other people's files and a terminal obeys
/// control characters. Characters in `kept` stay.
std::string harmless(std::string_view text, std::string_view kept) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length =
        kept.find(text[i]) != kept.npos ? 1 : shown_length(text.substr(i));
    if (length == 0) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
    } else {
      shown += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return shown;
}

// Prints one line. A failure is ignored: standard error may be closed.
void print_line(std::string_view label, const char* colour,
                std::string_view text) {
  const std::string safe = harmless(text, "\t");
  std::string line = colour_wanted() ? fmt::format("\033[{}m{}\033[0m{}\n",
                                                   colour, label, safe)
                                     : fmt::format("{}{}\n", label, safe);
  if (progress_shown) line.insert(0, kClear);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void set_quiet(bool quiet) { prints_errors_only = quiet; }

void print_result(std::string_view text) {
  print_bytes(harmless(text, "\n\t"));
}

void print_bytes(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
      std::fflush(stdout) == 0)
    return;
  // Who reads may have enough, as head has; the command goes on to its status.
  if (errno != EPIPE)
    throw std::runtime_error("cannot write to standard output");
}

void print_note(std::string_view text) {
  if (!prints_errors_only) print_line("", "0", text);
}

void print_warning(std::string_view text) {
  if (!prints_errors_only) print_line("beamgyro: warning: ", "33", text);
}

void keep_warning(const std::string& text) { kept_warnings.insert(text); }

void print_kept_warnings() {
  for (const std::string& text : kept_warnings) print_warning(text);
  kept_warnings.clear();
}

void print_error(std::string_view text) {
  print_line("beamgyro: ", "31", text);
}

bool is_quiet() { return prints_errors_only; }

std::string shortened(std::string_view text, std::size_t width) {
  if (text.size() <= width) return std::string(text);
  const std::size_t dots = std::min<std::size_t>(width, 3);
  std::size_t end = width - dots;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
    --end;  // not within a character
  return std::string(text.substr(0, end)) + std::string(dots, '.');
}

std::size_t terminal_width() {
  constexpr std::size_t kUsual = 80, kNarrowest = 20;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
    return kUsual;
  return std::max<std::size_t>(size.ws_col, kNarrowest);
}

bool shows_progress() {
  return !prints_errors_only && isatty(STDERR_FILENO) == 1;
}

void print_progress(std::string_view text) {
  if (interrupted) return;
  const std::string line = fmt::format(
      "{}{}", kClear, shortened(harmless(text, ""), terminal_width() - 1));
  std::fwrite(line.data(), 1, line.size(), stderr);
  progress_shown = !text.empty();
}

void set_interrupt_note(std::string_view text) {
  const std::string safe = harmless(text, "").substr(0, interrupt_note.size());
  interrupt_note_size = 0;
  safe.copy(interrupt_note.data(), safe.size());
  interrupt_note_size = safe.size();
}

void print_interrupted() noexcept {
  interrupted = true;
  const auto put = [](std::string_view text) {
    // What cannot be written on the way out is lost.
    [[maybe_unused]] const ssize_t ignored =
        ::write(STDERR_FILENO, text.data(), text.size());
  };
  // Also removes the ^C that the terminal shows.
  if (isatty(STDERR_FILENO) == 1) put(kClear);
  if (prints_errors_only) return;
  put("beamgyro: interrupted");
  if (const std::size_t size = interrupt_note_size; size > 0) {
    put("; ");
    put({interrupt_note.data(), size});
  }
  put("\n");
}

}  // namespace beamgyro::internal
