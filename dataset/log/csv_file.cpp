// SPDX-License-Identifier: MIT
#include "dataset/log/csv_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "dataset/files/number_text.h"
#include "dataset/files/text_file.h"

namespace beamgyro::internal {
namespace {

/// One cell without the blanks around it, and where it starts in its line.
struct Cell {
  std::string_view text;
  std::size_t column;  // from 1
};

void split_line(std::string_view line, std::vector<Cell>& cells) {
  cells.clear();
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    std::size_t first = start, last = comma;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t'))
      --last;
    cells.push_back({line.substr(first, last - first), first + 1});
    start = comma + 1;
  }
}

std::string shown(std::string_view cell) {
  std::string text = "'";
  for (const char c : cell.substr(0, 40)) {
    const auto byte = static_cast<unsigned char>(c);
    text += byte < 0x20 || byte >= 0x7f ? fmt::format("\\x{:02x}", byte)
                                        : std::string(1, c);
  }
  return text + (cell.size() > 40 ? "...'" : "'");
}

class CsvReader {
 public:
  CsvReader(std::string_view text, const std::filesystem::path& path,
            bool allow_nan = false)
      : text_(text), allow_nan_(allow_nan) {
    table_.path = path;
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    while (!text_.empty() && (text_.back() == '\n' || text_.back() == '\r' ||
                              text_.back() == ' ' || text_.back() == '\t'))
      text_.remove_suffix(1);
  }

  CsvTable read() {
    take_first_line();
    while (!text_.empty()) {
      next_line();
      take_row();
    }
    if (table_.columns.front().empty())
      fail(1, "only a line of names; expected rows of numbers below it");
    return std::move(table_);
  }

  std::vector<std::string> names() {
    take_first_line();
    return std::move(table_.names);
  }

 private:
  void take_first_line() {
    if (text_.empty()) fail(1, "the file is empty; expected rows of numbers");
    next_line();
    table_.columns.resize(cells_.size());
    if (std::any_of(cells_.begin(), cells_.end(), [](const Cell& cell) {
          return number_in(cell.text).has_value();
        })) {
      take_row();
    } else {
      take_names();
    }
  }

  void next_line() {
    ++line_;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    split_line(line, cells_);
  }

  void take_names() {
    std::set<std::string_view> met;
    for (const Cell& cell : cells_) {
      std::string_view name = cell.text;
      if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
      if (name.empty()) fail(cell.column, "a column without a name");
      if (!met.insert(name).second)
        fail(cell.column,
             fmt::format("two columns are called {}", shown(name)));
      table_.names.emplace_back(name);
    }
  }

  void take_row() {
    const std::size_t width = table_.columns.size();
    if (cells_.size() != width) {
      const Cell& last = cells_[std::min(cells_.size() - 1, width)];
      fail(last.column,
           fmt::format("{} cells; expected {} as in the first line",
                       cells_.size(), width));
    }
    for (std::size_t i = 0; i < width; ++i) {
      const std::optional<double> value = number_in(cells_[i].text);
      if (!value) {
        fail(cells_[i].column, fmt::format("{} is not a number; expected one "
                                           "such as -12.5",
                                           shown(cells_[i].text)));
      }
      if (!std::isfinite(*value) && !(allow_nan_ && std::isnan(*value))) {
        fail(cells_[i].column,
             fmt::format("{} is nan, infinite or out of range; expected a "
                         "finite number",
                         shown(cells_[i].text)));
      }
      table_.columns[i].push_back(*value);
    }
  }

  [[noreturn]] void fail(std::size_t column, const std::string& message) const {
    throw std::invalid_argument(
        fmt::format("{}:{}:{}: {}", table_.path.string(),
                    std::max(line_, std::size_t{1}), column, message));
  }

  std::string_view text_;  // what is not read yet
  bool allow_nan_;
  std::size_t line_ = 0;     // of the last line read, from 1
  std::vector<Cell> cells_;  // of that line
  CsvTable table_;
};

}  // namespace

const std::vector<double>& CsvTable::column(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(fmt::format(
        "{}:1:1: no column '{}'; the file has {}", path.string(), name,
        names.empty() ? "no line of names"
                      : fmt::format("{}", fmt::join(names, ", "))));
  }
  return columns[static_cast<std::size_t>(found - names.begin())];
}

std::string CsvTable::place(std::size_t row) const {
  return fmt::format("{}:{}", path.string(), row + (names.empty() ? 1 : 2));
}

CsvTable parse_csv(std::string_view text, const std::filesystem::path& path,
                   bool allow_nan) {
  return CsvReader(text, path, allow_nan).read();
}

std::vector<std::string> csv_names(std::string_view text,
                                   const std::filesystem::path& path) {
  return CsvReader(text.substr(0, text.find('\n')), path).names();
}

CsvTable read_csv(const std::filesystem::path& path) {
  return parse_csv(read_text_file(path), path);
}

}  // namespace beamgyro::internal
