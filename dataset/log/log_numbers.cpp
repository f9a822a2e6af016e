// SPDX-License-Identifier: MIT
#include "dataset/log/log_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "config/config_node.h"
#include "config/cut_text.h"
#include "config/suggestion.h"
#include "dataset/log/log_advice.h"

namespace beamgyro::internal {
namespace {

template <class Number>
std::errc parse(std::string_view text, Number& number) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || text.empty())
    return std::errc::invalid_argument;
  return error;
}

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

std::string listed(std::vector<std::string> names) {
  constexpr std::size_t kLongestList = 4000;
  for (std::string& name : names) name = printable(name);
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  if (all.size() <= kLongestList) return all;
  return fmt::format("{}..., {} columns in all", cut_text(all, kLongestList),
                     names.size());
}

// Column of the text that `column` of the map means, from 0.
std::size_t index_of(const LogColumn& column, const LogText& text,
                     const std::string& path) {
  const auto reject = [&](const std::string& message) {
    throw std::invalid_argument(fmt::format("{}: {}", column.place, message));
  };
  if (column.number > 0) {
    if (column.number > text.width()) {
      reject(fmt::format("{} is out of range; {} has {} columns", column.number,
                         path, text.width()));
    }
    return column.number - 1;
  }
  const std::vector<std::string>& names = text.names();
  if (names.empty()) {
    reject(
        fmt::format("\"{}\" is a name, and header = false; expected the "
                    "number of a column from 1",
                    column.name));
  }
  const auto found = std::find(names.begin(), names.end(), column.name);
  if (found == names.end()) {
    const std::string advice = name_advice(text, column.name);
    // One of another encoding cannot be written in a map.
    const std::string near = advice.find("UTF-8") == advice.npos
                                 ? suggestion(column.name, names)
                                 : "";
    reject(fmt::format(
        "{} has no column \"{}\"; {}it has {}{}", path, printable(column.name),
        near.empty() ? ""
                     : fmt::format("did you mean \"{}\"? ", printable(near)),
        listed(names), advice));
  }
  if (std::find(found + 1, names.end(), column.name) != names.end()) {
    reject(fmt::format("{} has two columns \"{}\"; expected the number of one",
                       path, column.name));
  }
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

LogNumbers::LogNumbers(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map)
    : text_(text, path, map.layout), map_(map), path_(path.string()) {}

std::size_t LogNumbers::slot(const LogColumn& column) {
  return text_.select(index_of(column, text_, path_));
}

std::optional<double> LogNumbers::number_in(std::size_t slot) const {
  const std::string_view cell = text_.cell(slot);
  if (is_marker(cell)) return std::nullopt;
  double value = 0.0;
  const std::errc error = parse_number(cell, value);
  if (error == std::errc() && std::isfinite(value)) return value;
  if (cell.empty() || equal_but_for_case(cell, "na") ||
      (error == std::errc() && std::isnan(value)))
    return std::nullopt;
  if (error == std::errc()) fail(slot, "is infinite", "a finite number");
  if (error == std::errc::result_out_of_range)
    fail(slot, "is out of range", "a finite number");
  fail(slot, "is not a number",
       number_advice(text_, map_.layout.decimal, cell));
}

// A comma is the decimal mark if the map says so, and then a point is none: it
// may separate thousands.
std::errc LogNumbers::parse_number(std::string_view cell,
                                   double& number) const {
  if (map_.layout.decimal == '.') return parse(cell, number);
  std::array<char, 64> point;
  if (cell.size() > point.size() || cell.find('.') != cell.npos)
    return std::errc::invalid_argument;
  std::replace_copy(cell.begin(), cell.end(), point.begin(), ',', '.');
  return parse({point.data(), cell.size()}, number);
}

bool LogNumbers::is_absent(std::size_t slot) const {
  const std::string_view cell = text_.cell(slot);
  const bool absent = cell.empty() || is_marker(cell) ||
                      equal_but_for_case(cell, "na") ||
                      equal_but_for_case(cell, "nan");
  if (absent && !map_.rules.drop_missing) fail_missing(slot);
  return absent;
}

void LogNumbers::fail_missing(std::size_t slot) const {
  text_.fail(slot, fmt::format("{} is missing; expected a number "
                               "(rules.missing = \"drop\" in the map drops "
                               "such rows)",
                               shown_cell(text_.cell(slot))));
}

std::optional<double> LogNumbers::present(std::size_t slot) const {
  const std::optional<double> number = number_in(slot);
  if (!number && !map_.rules.drop_missing) fail_missing(slot);
  return number;
}

std::optional<std::int64_t> LogNumbers::whole_in(std::size_t slot) const {
  constexpr std::int64_t kMost = std::int64_t{1} << 62;
  const std::string_view cell = text_.cell(slot);
  std::int64_t count = 0;
  if (is_marker(cell) || parse(cell, count) != std::errc()) return std::nullopt;
  if (count >= kMost || count <= -kMost) return std::nullopt;
  return count;
}

bool LogNumbers::is_marker(std::string_view cell) const {
  return std::any_of(map_.missing_markers.begin(), map_.missing_markers.end(),
                     [cell](const auto& marker) { return marker == cell; });
}

void LogNumbers::fail(std::size_t slot, const std::string& what,
                      const std::string& expected) const {
  text_.fail(slot, fmt::format("{} {}; expected {}",
                               shown_cell(text_.cell(slot)), what, expected));
}

}  // namespace beamgyro::internal
