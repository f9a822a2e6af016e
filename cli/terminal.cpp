// SPDX-License-Identifier: MIT
#include "cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>

namespace beamgyro {
namespace {

bool is_quiet = false;
std::set<std::string> kept_warnings;

bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) == 1 && !(no_colour && *no_colour);
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
  const std::string line =
      colour_wanted()
          ? fmt::format("\033[{}m{}\033[0m{}\n", colour, label, safe)
          : fmt::format("{}{}\n", label, safe);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void set_quiet(bool quiet) { is_quiet = quiet; }

void print_result(std::string_view text) {
  const std::string safe = harmless(text, "\n\t");
  if (std::fwrite(safe.data(), 1, safe.size(), stdout) != safe.size() ||
      std::fflush(stdout) != 0) {
    throw std::runtime_error("cannot write to standard output");
  }
}

void print_note(std::string_view text) {
  if (!is_quiet) print_line("", "0", text);
}

void print_warning(std::string_view text) {
  if (!is_quiet) print_line("beamgyro: warning: ", "33", text);
}

void keep_warning(const std::string& text) { kept_warnings.insert(text); }

void print_kept_warnings() {
  for (const std::string& text : kept_warnings) print_warning(text);
  kept_warnings.clear();
}

void print_error(std::string_view text) {
  print_line("beamgyro: ", "31", text);
}

bool shows_progress() { return !is_quiet && isatty(STDERR_FILENO) == 1; }

void print_progress(std::string_view text) {
  const std::string line = fmt::format("\r\033[K{}", harmless(text, ""));
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace beamgyro
