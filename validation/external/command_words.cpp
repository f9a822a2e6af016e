// SPDX-License-Identifier: MIT
#include "validation/external/command_words.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace beamgyro::internal {
namespace {

// After these words a command may follow.
constexpr std::string_view kBeforeCommands[] = {
    "!",     "if",    "then",    "elif", "else",  "while",
    "until", "do",    "{",       "time", "exec",  "command",
    "env",   "nohup", "builtin", "nice", "stdbuf"};

bool is_assignment(std::string_view word) {
  const std::size_t sign = word.find('=');
  if (sign == word.npos || sign == 0) return false;
  return std::ranges::all_of(word.substr(0, sign), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
}

class WordReader {
 public:
  std::vector<CommandWord> read(std::string_view text) {
    for (std::size_t k = 0; k < text.size(); ++k) {
      const char c = text[k];
      if (c == '\\' && quote_ != '\'' && k + 1 < text.size()) {
        if (text[++k] != '\n') add(text[k]);
      } else if (quote_ == '\'' || quote_ == '"') {
        take(c);
      } else if (c == '\'' || c == '"') {
        quote_ = c;
        begun_ = was_quoted_ = true;
      } else if (c == '#' && !begun_) {
        k = std::min(text.find('\n', k), text.size()) - 1;
      } else if (std::string_view(" \t\r").find(c) != std::string_view::npos) {
        end_word();
      } else if (std::string_view("\n;&|()<>`").find(c) !=
                 std::string_view::npos) {
        end_word();
        is_redirected_ = c == '<' || c == '>';
        if (!is_redirected_) expects_program_ = true;
      } else {
        add(c);
      }
    }
    end_word();
    return std::move(words_);
  }

 private:
  void add(char c) {
    word_ += c;
    begun_ = true;
  }
  void take(char c) {
    if (c == quote_)
      quote_ = '\0';
    else
      add(c);
  }
  void end_word() {
    if (!std::exchange(begun_, false)) return;
    CommandWord word{std::exchange(word_, {})};
    const bool was_quoted = std::exchange(was_quoted_, false);
    if (!std::exchange(is_redirected_, false) && expects_program_ &&
        !is_assignment(word.text)) {
      word.is_program = true;
      expects_program_ = std::ranges::find(kBeforeCommands, word.text) !=
                         std::ranges::end(kBeforeCommands);
    }
    words_.push_back(word);
    if (was_quoted && word.text.find_first_of(" \t\n") != word.text.npos)
      for (CommandWord& part : WordReader().read(word.text)) {
        part.within_quotes = true;
        part.is_program = false;
        words_.push_back(std::move(part));
      }
  }

  std::vector<CommandWord> words_;
  std::string word_;
  char quote_ = '\0';
  bool begun_ = false, was_quoted_ = false;
  bool expects_program_ = true, is_redirected_ = false;
};

}  // namespace

std::vector<CommandWord> command_words(std::string_view command) {
  return WordReader().read(command);
}

}  // namespace beamgyro::internal
