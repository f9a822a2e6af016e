// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// A word of a command of the shell.
struct CommandWord {
  std::string text;            // without its quotes
  bool is_program = false;     // the first one of a command
  bool within_quotes = false;  // one of several in a quoted word
};

/// Returns the words of a command of the shell, without its operators. Quotes
/// and backslashes are taken away; variables, patterns and substitutions stay
/// as they are written. The parts of a quoted word with spaces, which another
/// shell may read, follow it.
std::vector<CommandWord> command_words(std::string_view command);

}  // namespace beamgyro::internal
