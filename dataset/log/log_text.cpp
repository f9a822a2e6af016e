// SPDX-License-Identifier: MIT
#include "dataset/log/log_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view unquoted(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    return trimmed(text.substr(1, text.size() - 2));
  return text;
}

bool is_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

char delimiter_of(std::string_view line, char decimal) {
  for (const char c : {'\t', ';', ','})
    if (c != decimal && line.find(c) != line.npos) return c;
  return trimmed(line).find(' ') != line.npos || decimal == ',' ? ' ' : ',';
}

// Whatever the delimiter is.
bool holds_cell(std::string_view line, std::string_view word) {
  while (!line.empty()) {
    const std::size_t end =
        std::min(line.find_first_of("\t;,|\r"), line.size());
    if (unquoted(trimmed(line.substr(0, end))) == word) return true;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return false;
}

struct BinaryKind {
  std::string_view magic;  // its first bytes
  const char *what, *expected;
};

constexpr const char* kConverted =
    "the CSV and the map that scripts/flight_log_to_csv.py makes of it";
constexpr BinaryKind kBinaryKinds[] = {
    {"ULog\x01\x12\x35", "a ULog file of PX4", kConverted},
    {"\xA3\x95", "a DataFlash log of ArduPilot", kConverted},
    {"\x89HDF\r\n\x1A\n", "an HDF5 file",
     "text (a recording of this program needs no import)"},
    {"PK\x03\x04", "a ZIP archive or a spreadsheet", "text, exported as CSV"},
    {"\x1F\x8B", "compressed by gzip", "text, as gunzip makes it"},
};

}  // namespace

std::string shown_cell(std::string_view cell) {
  constexpr std::size_t kShown = 40;
  std::string text = "'";
  for (const char c : cell.substr(0, kShown)) {
    const auto byte = static_cast<unsigned char>(c);
    text += byte < 0x20 || byte == 0x7f ? fmt::format("\\x{:02x}", byte)
                                        : std::string(1, c);
  }
  return text + (cell.size() > kShown ? "...'" : "'");
}

LogText::LogText(std::string_view text, const std::filesystem::path& path,
                 const LogLayout& layout)
    : text_(text), path_(path.string()), layout_(layout) {
  if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
    throw std::invalid_argument(
        fmt::format("{}:1:1: the text is UTF-16; expected UTF-8", path_));
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  for (const BinaryKind& kind : kBinaryKinds) {
    if (!text_.starts_with(kind.magic)) continue;
    throw std::invalid_argument(fmt::format("{}: this is {}; expected {}",
                                            path_, kind.what, kind.expected));
  }
  if (const std::size_t nul = text_.find('\0'); nul != text_.npos) {
    const std::string_view before = text_.substr(0, nul);
    const std::size_t start = before.rfind('\n') + 1;  // 0 when there is none
    throw std::invalid_argument(fmt::format(
        "{}:{}:{}: a NUL byte; expected text with one row a line", path_,
        std::count(before.begin(), before.end(), '\n') + 1, nul - start + 1));
  }
  if (text_.find('\n') == text_.npos && text_.find('\r') != text_.npos)
    line_end_ = '\r';
  start();
}

// Reads to the line above the first row, after which the layout is known.
void LogText::start() {
  rest_ = text_;
  line_ = 0;
  const std::size_t above =
      layout_.header_line > 0 ? layout_.header_line - 1 : 0;
  while (line_ < above && !rest_.empty()) {
    const std::size_t end = std::min(rest_.find(line_end_), rest_.size());
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
  }
  const auto skip_rows = [this] {
    for (std::size_t i = 0; i < layout_.skip_rows; ++i)
      if (!next_line()) return;
  };
  if (!layout_.header) skip_rows();
  const std::string_view first_row = rest_;
  const std::size_t line_above = line_;
  if (!next_line()) {
    throw std::invalid_argument(
        text_.empty()
            ? fmt::format("{}:1:1: the file is empty; expected a log", path_)
            : fmt::format("{}:{}:1: no line is left; expected {}", path_,
                          std::max(line_, std::size_t{1}),
                          layout_.header ? "a line of names" : "rows"));
  }
  if (layout_.delimiter == 0)
    layout_.delimiter = delimiter_of(row_, layout_.decimal);
  if (layout_.header) {
    if (names_.empty()) read_names();
    skip_rows();
  } else {
    width_ = quoted_cells().size();
    rest_ = first_row;
    line_ = line_above;
  }
}

void LogText::read_names() {
  const std::vector<std::string_view> cells = quoted_cells();
  names_ = all_cells();
  names_row_ = row_;
  width_ = names_.size();
  if (std::all_of(cells.begin(), cells.end(), is_number))
    fail_at(1, fmt::format("{} is a number; expected the line of names (or "
                           "header = false in the map)",
                           shown_cell(cells.front())));
}

bool LogText::is_repeated_header(std::string_view line) const {
  return !names_row_.empty() && !layout_.repeated_header.empty() &&
         line.starts_with(layout_.repeated_header);
}

// Reads on to the next line of names, which it leaves out, too.
void LogText::skip_repeated_header() {
  const std::size_t first = line_;
  const auto next = [this] {
    const std::size_t end = std::min(rest_.find(line_end_), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  };
  while (!rest_.empty())
    if (trimmed(next()) == trimmed(names_row_)) return;
  throw std::invalid_argument(fmt::format(
      "{}:{}:1: a header that no line of names ends; expected the line {} "
      "below it, or another repeated_header in the map",
      path_, first, shown_cell(trimmed(names_row_))));
}

bool LogText::next_line() {
  while (!rest_.empty()) {
    const void* found = std::memchr(rest_.data(), line_end_, rest_.size());
    const std::size_t size =
        found == nullptr ? rest_.size()
                         : static_cast<std::size_t>(
                               static_cast<const char*>(found) - rest_.data());
    row_ = rest_.substr(0, size);
    rest_.remove_prefix(std::min(size + 1, rest_.size()));
    ++line_;
    if (row_.ends_with('\r')) row_.remove_suffix(1);
    std::size_t first = 0;
    while (first < row_.size() && row_[first] == ' ') ++first;
    const std::string_view shown = row_.substr(first);
    if (is_repeated_header(shown)) {
      skip_repeated_header();
      continue;
    }
    const bool is_comment = std::any_of(
        layout_.comment_prefixes.begin(), layout_.comment_prefixes.end(),
        [&](const auto& prefix) { return shown.starts_with(prefix); });
    if (!shown.empty() && !is_comment) return true;
  }
  return false;
}

const char* LogText::cell_end(const char* begin, const char* end) const {
  while (begin != end && *begin == ' ') ++begin;
  if (begin != end && *begin == '"') {
    const void* closing =
        std::memchr(begin + 1, '"', static_cast<std::size_t>(end - begin - 1));
    if (closing == nullptr)
      fail_at(static_cast<std::size_t>(begin - row_.data()) + 1,
              "a quote that is not closed on its line; expected a second '\"'");
    begin = static_cast<const char*>(closing);
  }
  if (layout_.delimiter == ' ') return std::find_if(begin, end, is_blank);
  const void* found = std::memchr(begin, layout_.delimiter,
                                  static_cast<std::size_t>(end - begin));
  return found == nullptr ? end : static_cast<const char*>(found);
}

const char* LogText::first_cell() const {
  if (layout_.delimiter != ' ') return row_.data();
  return std::find_if_not(row_.data(), row_.data() + row_.size(), is_blank);
}

// The cell after one that ends at `stop`, or null.
const char* LogText::next_cell(const char* stop, const char* end) const {
  if (layout_.delimiter == ' ') stop = std::find_if_not(stop, end, is_blank);
  if (stop == end) return nullptr;
  return layout_.delimiter == ' ' ? stop : stop + 1;
}

std::vector<std::string_view> LogText::quoted_cells() const {
  std::vector<std::string_view> cells;
  const char* const end = row_.data() + row_.size();
  for (const char* begin = first_cell(); begin != nullptr;) {
    const char* const stop = cell_end(begin, end);
    cells.push_back(trimmed({begin, static_cast<std::size_t>(stop - begin)}));
    begin = next_cell(stop, end);
  }
  return cells;
}

std::vector<std::string> LogText::all_cells() const {
  std::vector<std::string> cells;
  for (const std::string_view cell : quoted_cells())
    cells.emplace_back(unquoted(cell));
  return cells;
}

std::size_t LogText::line_holding(std::string_view word) const {
  constexpr std::size_t kMost = 100;
  std::string_view rest = rest_;
  for (std::size_t k = 1; k <= kMost && !rest.empty(); ++k) {
    const std::string_view line = rest.substr(0, rest.find(line_end_));
    if (holds_cell(line, word)) return line_ + k;
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  return 0;
}

void LogText::cut() {
  const char* const end = row_.data() + row_.size();
  std::size_t next = 0;  // of order_
  bool empty = false;
  cells_ = 0;
  for (const char* begin = first_cell(); begin != nullptr; ++cells_) {
    const char* const stop = cell_end(begin, end);
    for (; next < order_.size() && selected_[order_[next]].index == cells_;
         ++next) {
      SelectedColumn& column = selected_[order_[next]];
      const std::string_view cell{begin,
                                  static_cast<std::size_t>(stop - begin)};
      column.text = unquoted(trimmed(cell));
      column.column = static_cast<std::size_t>(begin - row_.data()) + 1;
      if (!column.text.empty())
        column.column =
            static_cast<std::size_t>(column.text.data() - row_.data()) + 1;
    }
    empty = stop == begin;
    begin = next_cell(stop, end);
  }
  if (empty && cells_ == width_ + 1) --cells_;
  for (; next < order_.size(); ++next) {
    SelectedColumn& column = selected_[order_[next]];
    column.text = {};
    column.column = row_.size() + 1;
  }
}

std::size_t LogText::select(std::size_t index) {
  selected_.push_back({index, {}, 1});
  order_.push_back(selected_.size() - 1);
  std::stable_sort(order_.begin(), order_.end(),
                   [this](std::size_t a, std::size_t b) {
                     return selected_[a].index < selected_[b].index;
                   });
  return selected_.size() - 1;
}

bool LogText::next() {
  if (!next_line()) return false;
  if (first_row_ == 0) first_row_ = line_;
  cut();
  return true;
}

void LogText::return_to(std::size_t line) {
  start();
  while (line_ < line && next()) continue;
}

void LogText::fail_at(std::size_t column, const std::string& message) const {
  throw std::invalid_argument(
      fmt::format("{}:{}:{}: {}", path_, line_, column, message));
}

void LogText::fail(std::size_t slot, const std::string& message) const {
  fail_at(selected_[slot].column, message);
}

void LogText::fail_row(const std::string& message) const {
  fail_at(row_.size() + 1, message);
}

}  // namespace beamgyro::internal
