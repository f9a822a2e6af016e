// SPDX-License-Identifier: MIT
#include "dataset/log/log_time.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "config/config_node.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

// A time of the log in the form of its column.
std::optional<LogTicks> read_ticks(const ConfigTable& table,
                                   const LogTime& time, const char* key) {
  if (!table.has(key)) return std::nullopt;
  if (time.format) {
    const std::string text = table.text(key);
    const std::optional<std::int64_t> count = time.format->read(text);
    if (!count) {
      table.fail(key,
                 fmt::format("\"{}\" is no time of the form \"{}\"; "
                             "expected one such as \"{}\"",
                             printable(text), printable(time.format->pattern()),
                             printable(time.format->example())));
    }
    return whole_ticks(*count);
  }
  const double number = table.number(key);
  const ConfigNode& node = table.value(key);
  constexpr long kMost = 1L << 62;
  if (node.kind == ConfigNode::Kind::kInteger && node.integer > -kMost &&
      node.integer < kMost)
    return whole_ticks(node.integer);
  return LogTicks{number, {}};
}

void read_format(const ConfigTable& table, LogTime& time) {
  const std::string pattern = table.text("format");
  try {
    time.format.emplace(pattern);
  } catch (const std::invalid_argument& error) {
    table.fail("format",
               fmt::format("\"{}\": {}", printable(pattern), error.what()));
  }
  time.place = table.place("format");
  time.ticks_per_s = static_cast<double>(kNanosecondsPerSecond);
  if (table.has("date_column"))
    time.date_column = read_log_column(table, "date_column");
}

std::string read_unit_name(const ConfigTable& table) {
  const std::vector<std::string> units = {"s",   "ms", "us",   "ns",
                                          "min", "h",  "index"};
  if (table.has("unit")) return table.choice("unit", units);
  try {
    return table.choice("unit", units);
  } catch (const std::invalid_argument& missing) {
    throw std::invalid_argument(
        fmt::format("{} (a column of dates or times of the day has time.format "
                    "= \"iso\", or a pattern, instead)",
                    missing.what()));
  }
}

void read_unit(const ConfigTable& table, LogTime& time) {
  time.wrap_bits = static_cast<int>(table.integer_or("wrap_bits", 0, 8, 53));
  time.unit = read_unit_name(table);
  time.place = table.place("unit");
  if (time.unit == "index") {
    time.ticks_per_s = table.number("rate_Hz", positive());
    return;
  }
  static_cast<void>(table.has("rate_Hz"));
  const double scale = unit_conversion(time.unit, "s").scale;
  if (scale > 1) {
    time.tick_s = scale;
  } else {
    time.ticks_per_s = std::round(1.0 / scale);
  }
}

}  // namespace

LogTicks whole_ticks(std::int64_t count) {
  return {static_cast<double>(count), count};
}

LogTime read_log_time(const ConfigTable& table) {
  LogTime time;
  time.offset = table.optional_number("offset_s");
  if (!table.has("column")) {
    for (const char* key : {"unit", "wrap_bits", "format", "date_column"})
      static_cast<void>(table.has(key));
    time.ticks_per_s = table.number("rate_Hz", positive());
    time.place = table.place("rate_Hz");
  } else {
    time.column = read_log_column(table);
    if (table.has("format")) {
      for (const char* key : {"unit", "wrap_bits", "rate_Hz"})
        static_cast<void>(table.has(key));
      read_format(table, time);
    } else {
      static_cast<void>(table.has("date_column"));
      read_unit(table, time);
    }
  }
  time.zero = read_ticks(table, time, "zero");
  time.from = read_ticks(table, time, "from");
  time.to = read_ticks(table, time, "to");
  if (time.from && time.to && !(time.to->since(*time.from) > 0))
    table.fail("to", "is not after from; expected a later time");
  return time;
}

}  // namespace beamgyro::internal
