// SPDX-License-Identifier: MIT
#include "cli/input_lines.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace beamgyro::internal {

void InputLines::read() {
  std::array<char, 1 << 16> bytes;
  const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (n < 0 && errno == EINTR) return;
  if (n < 0)
    throw std::system_error(errno, std::generic_category(),
                            "cannot read standard input");
  text_.append(bytes.data(), static_cast<std::size_t>(n));
  ended_ = n == 0;
}

std::optional<InputLine> InputLines::next() {
  std::size_t end = text_.find('\n', searched_);
  if (skips_ && end != text_.npos) {
    begin_ = end + 1;
    end = text_.find('\n', begin_);
    skips_ = false;
  }
  if (skips_ || (end == text_.npos && ended_)) {
    InputLine left{text_.substr(begin_), LineEnd::kCutOff};
    forget_before(text_.size());
    if (skips_ || left.text.empty()) return std::nullopt;
    return left;
  }
  const bool whole = end != text_.npos;
  if (!whole) end = text_.size();
  const bool too_long = end - begin_ > kLongestInputLine;
  if (!whole && !too_long) {
    forget_before(begin_);
    return std::nullopt;
  }
  InputLine line{{}, too_long ? LineEnd::kTooLong : LineEnd::kWhole};
  if (!too_long) line.text = text_.substr(begin_, end - begin_);
  begin_ = searched_ = whole ? end + 1 : end;
  skips_ = !whole;
  return line;
}

// All that is left has no end of a line.
void InputLines::forget_before(std::size_t begin) {
  text_.erase(0, begin);
  begin_ = 0;
  searched_ = text_.size();
}

}  // namespace beamgyro::internal
