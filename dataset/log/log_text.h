// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Layout of the text of a log.
struct LogLayout {
  char delimiter = 0;  // ' ': blanks; 0: the first of tab, ';', ',' and
                       // blanks that is in the first line
  bool header = true;  // the first line holds names
  std::size_t header_line = 0;  // from 1: lines above it are left out; 0: none
  std::size_t skip_rows = 0;    // below the names, or at the start
  // Lines with one of these prefixes are comments.
  std::vector<std::string> comment_prefixes = {};
  // A line with this prefix, and those down to the next line of names, are left
  // out; none when it is empty.
  std::string repeated_header = {};
  char decimal = '.';  // mark of numbers; ',' is then not found as a delimiter
};

/// Reads delimiter-separated text row by row and extracts the cells of selected
/// columns. Accepts a UTF-8 byte-order mark, lines that end in LF, CRLF or CR
/// alone, blanks around a cell, cells in double quotes, empty lines, and one
/// delimiter too many at the end of a row. Errors are std::invalid_argument
/// "file:line:column: ...". The text must outlive it.
class LogText {
 public:
  /// Reads up to the first row. Throws for an empty or binary text, and for a
  /// line of names that is missing or has numbers only.
  LogText(std::string_view text, const std::filesystem::path& path,
          const LogLayout& layout);

  const std::vector<std::string>& names() const { return names_; }
  std::size_t width() const { return width_; }  // cells of the first line
  char delimiter() const { return layout_.delimiter; }  // ' ': blanks
  std::size_t skipped_rows() const { return layout_.skip_rows; }

  /// Returns the number of the first line below that of the names that has the
  /// cell `word`; 0 when none of the next hundred has.
  std::size_t line_holding(std::string_view word) const;

  /// Selects the column `index` (from 0) for the rows to come. Returns the slot
  /// of its cells.
  std::size_t select(std::size_t index);

  bool next();                       // to the next row; false after the last
  void return_to(std::size_t line);  // to a row that was met before

  std::size_t line() const { return line_; }    // of the row, from 1
  std::size_t cells() const { return cells_; }  // of the row
  bool is_whole() const { return cells_ == width_; }
  bool is_short() const { return cells_ < width_; }
  std::string_view cell(std::size_t slot) const { return selected_[slot].text; }
  std::string_view row() const { return row_; }
  bool is_first_row() const { return line_ == first_row_; }
  std::vector<std::string> all_cells() const;  // of the row

  /// Throws "file:line:column: message" at a cell of the row, or at its end.
  [[noreturn]] void fail(std::size_t slot, const std::string& message) const;
  [[noreturn]] void fail_row(const std::string& message) const;

 private:
  struct SelectedColumn {
    std::size_t index;
    std::string_view text;
    std::size_t column;  // of the text in its line, from 1
  };

  bool next_line();
  bool is_repeated_header(std::string_view line) const;
  void skip_repeated_header();
  void start();
  void read_names();
  void cut();
  const char* first_cell() const;
  const char* next_cell(const char* stop, const char* end) const;
  const char* cell_end(const char* begin, const char* end) const;
  std::vector<std::string_view> quoted_cells() const;
  [[noreturn]] void fail_at(std::size_t column,
                            const std::string& message) const;

  std::string_view text_, rest_, row_;
  std::string_view names_row_;
  std::string path_;
  LogLayout layout_;
  char line_end_ = '\n';
  std::vector<std::string> names_;
  std::size_t width_ = 0, line_ = 0, cells_ = 0;
  std::size_t first_row_ = 0;  // its line; 0: not met
  std::vector<SelectedColumn> selected_;
  std::vector<std::size_t> order_;  // slots by index
};

/// Returns a cell in the form used in messages.
std::string shown_cell(std::string_view cell);

}  // namespace beamgyro::internal
