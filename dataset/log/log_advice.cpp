// SPDX-License-Identifier: MIT
#include "dataset/log/log_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "config/config_node.h"
#include "dataset/log/log_date.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr const char* kByNumber = "columns by number in the map";

bool begins_like_number(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("+-.,"), text.size()));
  return !text.empty() && kDigits.find(text.front()) != kDigits.npos;
}

// A row that holds no number, such as a line of units.
bool is_first_line_of_words(const LogText& log) {
  const std::vector<std::string> cells = log.all_cells();
  return log.is_first_row() &&
         std::none_of(cells.begin(), cells.end(), begins_like_number);
}

// A cell of letters, as within a header, and not a lone mark such as "-".
bool has_words_only(const LogText& log, std::string_view cell) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !log.names().empty() && cell.size() > 3 &&
         std::ranges::all_of(cell.substr(0, 4), is_letter);
}

// The beginning of the row, which ends with a whole cell.
std::string_view beginning_of(std::string_view row, char delimiter) {
  constexpr std::size_t kMost = 40;
  row.remove_prefix(std::min(row.find_first_not_of(' '), row.size()));
  if (row.size() <= kMost) return row;
  return row.substr(0, std::max(row.rfind(delimiter, kMost) + 1, 1ul));
}

// The number 1.5D-03 in the form that is read, or an empty text.
std::string without_fortran(std::string_view cell) {
  std::string text(cell);
  const std::size_t mark = text.find_first_of("Dd");
  if (mark == text.npos) return "";
  text[mark] = 'e';
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ptr == end ? text : "";
}

// The first other delimiter that the text holds, or 0. A comma is none beside a
// decimal comma.
char other_delimiter(std::string_view text, char used, char decimal) {
  for (const char c : {'\t', ';', ',', '|'})
    if (c != used && c != decimal && text.find(c) != text.npos) return c;
  return 0;
}

std::string shown_delimiter(char delimiter) {
  return delimiter == '\t' ? "\"\\t\"" : fmt::format("\"{}\"", delimiter);
}

std::string with_delimiter(const LogText& log, char other) {
  return fmt::format("delimiter = {} in the map in place of {}",
                     shown_delimiter(other), shown_delimiter(log.delimiter()));
}

bool is_utf8(const std::string& text) {
  try {
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x80;
  });
}

// How many lines are to be skipped when the line of names is no more one.
std::size_t rows_above(const LogLayout& layout) {
  return std::max(layout.header_line, std::size_t{1}) + layout.skip_rows;
}

std::string decimal_advice(const LogText& log, char decimal,
                           std::string_view cell) {
  const bool comma = decimal == ',';
  const char other = comma ? '.' : ',';
  if (cell.find(decimal) != cell.npos && cell.find(other) != cell.npos)
    return fmt::format("one such as {}, without marks of thousands",
                       comma ? "2548,866" : "2548.866");
  if (std::count(cell.begin(), cell.end(), other) != 1 ||
      cell.find(decimal) != cell.npos)
    return "a number alone, such as -12.5; its unit is stated by the map";
  return fmt::format("one such as {}, or {}decimal = \"{}\" in the map",
                     comma ? "-12,5" : "-12.5",
                     log.delimiter() == other ? "delimiter = \",\" and " : "",
                     other);
}

}  // namespace

std::string number_advice(const LogText& log, char decimal,
                          std::string_view cell) {
  if (!log.names().empty() && log.all_cells() == log.names()) {
    return fmt::format(
        "the line of names once: this row has the names again (header = false, "
        "comment_prefixes = ['{}'] and {} leave such lines out)",
        printable(beginning_of(log.row(), log.delimiter())), kByNumber);
  }
  if (is_first_line_of_words(log)) {
    return fmt::format(
        "a row of numbers (skip_rows = {} in the map leaves out a line of "
        "units)",
        log.skipped_rows() + 1);
  }
  if (cell.find_first_of(kDigits) == cell.npos)
    return has_words_only(log, cell)
               ? fmt::format(
                     "one such as -12.5, or in the map the text among "
                     "missing_markers, comment_prefixes for a comment, "
                     "repeated_header = \"{}\" for the first line of "
                     "a header that is repeated in the log",
                     printable(log.all_cells().front()))
               : std::string(
                     "one such as -12.5, or the text among "
                     "missing_markers in the map");
  if (const std::string number = without_fortran(cell); !number.empty())
    return fmt::format("one such as {}, with e before the exponent", number);
  if (looks_like_date(cell))
    return "a number (a column of dates or times of the day is read by "
           "time.format = \"iso\", or a pattern, in the map)";
  if (const char other = other_delimiter(cell, log.delimiter(), ','))
    return "one number in a cell, with " + with_delimiter(log, other);
  return decimal_advice(log, decimal, cell);
}

std::string width_advice(const LogText& log, const LogLayout& layout) {
  const std::string expected =
      fmt::format("expected {} as in the first line", log.width());
  const std::vector<std::string> cells = log.all_cells();
  const auto two_dates = std::adjacent_find(
      cells.begin(), cells.end(), [](const auto& a, const auto& b) {
        return looks_like_date(a) && looks_like_date(b);
      });
  if (layout.header && log.delimiter() == ' ' && two_dates != cells.end()) {
    return fmt::format(
        "{}; a date and a time between blanks are two columns: header = false, "
        "skip_rows = {} and {}, with time.date_column and time.column, read "
        "them",
        expected, rows_above(layout), kByNumber);
  }
  if (log.delimiter() == ',' && layout.decimal == ',') {
    return expected +
           ", and a number with a decimal comma in quotes where the delimiter "
           "is a comma, too";
  }
  const char other =
      other_delimiter(log.row(), log.delimiter(), layout.decimal);
  if (log.cells() == 1 && other != 0) {
    return fmt::format("{}, or {}, with header = false, skip_rows = {} and {}",
                       expected, with_delimiter(log, other), rows_above(layout),
                       kByNumber);
  }
  if (log.is_short() && log.cells() > 1)
    return expected +
           " (or rules.ragged = \"fill\", which reads the cells that lack as "
           "empty, or \"drop\", in the map)";
  return expected + " (or rules.ragged = \"drop\" in the map)";
}

std::string name_advice(const LogText& log, const std::string& column) {
  const std::vector<std::string>& names = log.names();
  if (!is_ascii(column) && !std::all_of(names.begin(), names.end(), is_utf8))
    return "; the log is not UTF-8; expected UTF-8, or the number of the "
           "column";
  if (const std::size_t line = log.line_holding(column))
    return fmt::format("; line {} holds it: header_line = {} in the map", line,
                       line);
  if (names.size() > 1) return "";
  const char other = other_delimiter(names.front(), log.delimiter(), 0);
  if (other == 0) return "";
  return fmt::format(
      "; expected {}, or, when only the names are so, header = false, "
      "skip_rows = 1 and {}",
      with_delimiter(log, other), kByNumber);
}

}  // namespace beamgyro::internal
