// SPDX-License-Identifier: MIT
#include "cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace beamgyro {
namespace {

bool is_quiet = false;

bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) == 1 && !(no_colour && *no_colour);
}

// Standard error may be closed; there is nobody left to tell then.
void print_line(std::string_view label, const char* colour,
                std::string_view text) {
  const std::string line =
      colour_wanted()
          ? fmt::format("\033[{}m{}\033[0m{}\n", colour, label, text)
          : fmt::format("{}{}\n", label, text);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void set_quiet(bool quiet) { is_quiet = quiet; }

void print_result(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() ||
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

void print_error(std::string_view text) {
  print_line("beamgyro: ", "31", text);
}

bool shows_progress() { return !is_quiet && isatty(STDERR_FILENO) == 1; }

void print_progress(std::string_view text) {
  const std::string line = fmt::format("\r\033[K{}", text);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace beamgyro
