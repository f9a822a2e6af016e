// SPDX-License-Identifier: MIT
#include "cli/live_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/refused_lines.h"
#include "dataset/log/recording_csv.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kExpectedNames =
    "expected time, and any of rate, cross_rate_x, cross_rate_y, "
    "acceleration_x, acceleration_y, acceleration_z, ambient_temperature, "
    "powered";

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(',', begin);
    cells.push_back(line.substr(begin, end - begin));
    if (end == line.npos) return cells;
    begin = end + 1;
  }
}

std::string_view trimmed(std::string_view cell) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = cell.find_first_not_of(kBlanks);
  if (first == cell.npos) return {};
  return cell.substr(first, cell.find_last_not_of(kBlanks) - first + 1);
}

double cell_number(std::string_view cell, std::string_view name,
                   const std::string& place) {
  const std::string_view text = trimmed(cell);
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw BadLine(LineFault::kNumber,
                  fmt::format("{}: {} is \"{}\"; expected a number", place,
                              name, text.substr(0, 40)));
  return value;
}

}  // namespace

LiveColumns::LiveColumns(const std::string& names, const std::string& place) {
  for (const std::string_view cell : cells_of(names)) {
    const ColumnName given = column_name(trimmed(cell));
    std::string_view bare = given.name;
    if (bare.starts_with("true_")) bare.remove_prefix(5);
    const auto inputs = gyro_inputs();
    const auto known = std::ranges::find(inputs, bare, &GyroInputSignal::name);
    const bool is_input = known != inputs.end();
    if (!is_input && given.name != "time" && given.name != "powered")
      throw std::invalid_argument(
          fmt::format("{}: column \"{}\" is no input of a gyro; {}", place,
                      given.name, kExpectedNames));
    const std::string_view unit = is_input               ? known->units
                                  : given.name == "time" ? "s"
                                                         : "1";
    if (!given.unit.empty() && given.unit != unit)
      throw std::invalid_argument(
          fmt::format("{}: column {} is in {}; expected {}", place, given.name,
                      given.unit, unit));
    const std::string name(is_input ? bare : std::string_view(given.name));
    if (std::ranges::find(columns_, name, &Column::name) != columns_.end())
      throw std::invalid_argument(
          fmt::format("{}: column {} is there twice", place, name));
    columns_.push_back({name, is_input ? known->value : nullptr});
  }
  if (std::ranges::find(columns_, "time", &Column::name) == columns_.end())
    throw std::invalid_argument(
        fmt::format("{}: no column time; {}", place, kExpectedNames));
}

TimedInputs LiveColumns::of(std::span<const double> values,
                            const TimedInputs& before,
                            const std::string& place) const {
  TimedInputs line = before;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    const double value = values[i];
    if (!std::isfinite(value))
      throw BadLine(LineFault::kValue,
                    fmt::format("{}: {} is {}; expected a finite number", place,
                                column.name, value));
    if (column.input != nullptr) {
      line.inputs.*column.input = value;
    } else if (column.name == "time") {
      line.time = value;
    } else if (value == 0 || value == 1) {
      line.inputs.powered = value == 1;
    } else {
      throw BadLine(
          LineFault::kValue,
          fmt::format("{}: powered is {}; expected 0 or 1", place, value));
    }
  }
  return line;
}

TimedInputs LiveColumns::of(std::string_view line, const TimedInputs& before,
                            const std::string& place) const {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != columns_.size())
    throw BadLine(
        LineFault::kCells,
        fmt::format("{}: {} cell{}; expected {} as in the line of names", place,
                    cells.size(), cells.size() == 1 ? "" : "s",
                    columns_.size()));
  std::vector<double> values;
  for (std::size_t i = 0; i < cells.size(); ++i)
    values.push_back(cell_number(cells[i], columns_[i].name, place));
  return of(values, before, place);
}

}  // namespace beamgyro::internal
