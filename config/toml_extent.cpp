// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "config/toml_parser.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kDeepest = 256;
constexpr std::size_t kMostValues = 500'000;

/// Scans a text for the ends of strings and comments, and for the depth of
/// nesting outside of them. It agrees with the parser up to the first error
/// that the parser would find.
class TomlScan {
 public:
  explicit TomlScan(std::string_view text) : text_(text) {
    if (text.starts_with("\xEF\xBB\xBF")) place_ = 3;  // byte order mark
  }

  void run() {
    while (place_ < text_.size()) step();
  }

 private:
  void step() {
    const char c = text_[place_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') return skip_comment();
    ++place_;
    if (c == '\n') return end_line();
    if (c == ' ' || c == '\t' || c == '\r') return;
    switch (c) {
      case '[':
      case '{':
        if (c == '[' && is_line_start_ && open_.empty()) {
          is_header_ = true;
          level_ = 0;
        }
        if (!is_header_) open();
        break;
      case ']':
      case '}':
        close();
        break;
      case '.':
        ++dots_;
        count();
        break;
      case '=':
        level_ += dots_ + 1;
        dots_ = 0;
        count();
        break;
      case ',':
        level_ = start();
        dots_ = 0;
        count();
        break;
      default:
        break;
    }
    is_line_start_ = false;
  }

  /// Returns the depth of the keys or values of the innermost open table or
  /// array.
  std::size_t start() const {
    return open_.empty() ? header_depth_ : open_.back();
  }

  void open() {
    open_.push_back(level_ + dots_ + 1);
    level_ = open_.back();
    dots_ = 0;
    count();
  }

  void close() {
    if (is_header_) {
      header_depth_ = dots_ + 1;
      is_header_ = false;
    } else if (!open_.empty()) {
      open_.pop_back();
    }
    level_ = start();
    dots_ = 0;
  }

  void end_line() {
    ++line_;
    line_begin_ = place_;
    is_line_start_ = true;
    is_header_ = false;
    if (open_.empty()) level_ = header_depth_;
    dots_ = 0;
  }

  void count() {
    if (level_ + dots_ >= kDeepest)
      fail(
          fmt::format("keys, tables and arrays nest deeper than {}; expected "
                      "at most that",
                      kDeepest));
    if (++values_ > kMostValues)
      fail(
          fmt::format("more than {} keys and values; expected fewer, and long "
                      "rows of numbers in a CSV file",
                      kMostValues));
  }

  void skip_comment() {
    place_ = std::min(text_.find('\n', place_), text_.size());
  }

  /// Skips a string in `quote`. Three quotes begin a string of several lines.
  void skip_string(char quote) {
    is_line_start_ = false;
    const std::string_view three(quote == '"' ? "\"\"\"" : "'''");
    const bool has_lines = text_.substr(place_).starts_with(three);
    place_ += has_lines ? 3 : 1;
    for (; place_ < text_.size(); ++place_) {
      const char c = text_[place_];
      if (c == '\n') {
        if (!has_lines) return;  // the parser stops here
        ++line_;
        line_begin_ = place_ + 1;
      } else if (c == '\\' && quote == '"') {
        // The end of a line that is escaped is counted all the same.
        if (place_ + 1 < text_.size() && text_[place_ + 1] != '\n') ++place_;
      } else if (c == quote && !has_lines) {
        ++place_;
        return;
      } else if (c == quote && text_.substr(place_).starts_with(three)) {
        place_ += 3;
        // Up to two quotes before the closing three belong to the text.
        for (int k = 0; k < 2 && place_ < text_.size(); ++k)
          place_ += text_[place_] == quote ? 1 : 0;
        return;
      }
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw TomlError(message, {line_, place_ - line_begin_});
  }

  std::string_view text_;
  std::size_t place_ = 0, line_ = 1, line_begin_ = 0;
  std::vector<std::size_t> open_;  // depth inside each bracket that is open
  std::size_t header_depth_ = 0;   // of the table whose keys follow
  std::size_t level_ = 0;          // depth of the key or value met next
  std::size_t dots_ = 0;           // of the key so far
  std::size_t values_ = 0;
  bool is_line_start_ = true, is_header_ = false;
};

}  // namespace

void check_toml_extent(std::string_view text) {
  if (text.size() > kLargestToml)
    throw TomlError(fmt::format("{} bytes; expected at most {}, and long rows "
                                "of numbers in a CSV file",
                                text.size(), kLargestToml),
                    {1, 1});
  TomlScan(text).run();
}

}  // namespace beamgyro::internal
