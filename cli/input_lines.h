// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace beamgyro::internal {

/// The longest line that is read [bytes].
inline constexpr std::size_t kLongestInputLine = std::size_t{1} << 16;

enum class LineEnd {
  kWhole,
  kTooLong,  // longer than kLongestInputLine
  kCutOff    // the last one, without an end
};

struct InputLine {
  std::string text;  // nothing of one that is too long
  LineEnd end;
};

/// Lines of standard input as they come, in bounded memory: each byte is looked
/// at once, and what follows in a line that is too long is thrown away.
class InputLines {
 public:
  /// Reads what there is, or waits for it. Throws std::system_error.
  void read();
  bool ended() const { return ended_; }
  /// Returns the next line, or nothing when it has not come yet. The one that
  /// is cut off comes after ended().
  std::optional<InputLine> next();

 private:
  void forget_before(std::size_t begin);

  std::string text_;
  std::size_t begin_ = 0, searched_ = 0;  // in text_
  bool skips_ = false;                    // up to the end of the line
  bool ended_ = false;
};

}  // namespace beamgyro::internal
