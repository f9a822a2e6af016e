// SPDX-License-Identifier: MIT
#include "dataset/log/log_column.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "config/config_node.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kFastestRate = 20000.0;               // [deg/s]
constexpr double kColdest = -100.0, kWarmest = 200.0;  // [degC]
constexpr long kMostColumns = 100000;

// The units that the map may state for a signal of the unit `units`.
std::vector<std::string> known_units(std::string_view units) {
  if (units == "degree/s")
    return {"deg/s", "deg/h", "rad/s", "mrad/s", "V", "mV", "counts"};
  if (units == "degC")
    return {"degC", "degF", "K", "V", "mV", "counts", "ohm", "kohm"};
  if (units == "Hz") return {"Hz", "kHz"};
  return {"V", "mV"};
}

double read_scale(const ConfigTable& table, std::string_view key) {
  const double scale = table.number(key);
  if (scale == 0.0)
    table.fail(key, "0 is out of range; expected a number other than 0");
  return scale;
}

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

bool LogQuantity::fits(double raw) const {
  return wrap_bits == 0 || (raw == std::floor(raw) && raw >= 0.0 &&
                            raw < std::ldexp(1.0, wrap_bits));
}

double LogQuantity::value(double raw) const {
  if (wrap_bits > 0 && raw >= std::ldexp(1.0, wrap_bits - 1))
    raw -= std::ldexp(1.0, wrap_bits);
  if (thermistor) return thermistor->temperature(raw * scale);
  return (raw - offset) * scale + shift;
}

LogColumn read_log_column(const ConfigTable& table, std::string_view key) {
  LogColumn column;
  column.place = table.place(key);
  if (table.holds_number(key)) {
    column.number =
        static_cast<std::size_t>(table.integer(key, 1, kMostColumns));
  } else {
    column.name = table.text(key);
    if (column.name.empty())
      table.fail(key, "\"\" is no name; expected the name of a column");
  }
  return column;
}

LogQuantity read_log_quantity(const ConfigTable& table,
                              std::string_view signal) {
  LogQuantity quantity;
  quantity.signal = recorded_signal(signal);
  quantity.column = read_log_column(table);
  const std::string_view units = quantity.signal.units;
  quantity.unit = table.choice("unit", known_units(units));
  quantity.unit_place = table.place("unit");
  const bool is_counts = quantity.unit == "counts";
  if (is_counts) {
    quantity.wrap_bits =
        static_cast<int>(table.integer_or("wrap_bits", 0, 2, 32));
  } else {
    static_cast<void>(table.has("wrap_bits"));
  }
  const bool is_rate = units == "degree/s", is_temperature = units == "degC";
  if (is_rate) {
    quantity.plausible = between(-kFastestRate, kFastestRate);
    quantity.offset = table.number_or("offset", 0.0);
  }
  if (is_temperature) quantity.plausible = between(kColdest, kWarmest);
  const bool is_raw =
      is_counts || quantity.unit == "V" || quantity.unit == "mV";
  const bool is_resistance = quantity.unit == "ohm" || quantity.unit == "kohm";
  if (is_temperature &&
      (is_resistance || (is_raw && table.has("thermistor")))) {
    if (quantity.unit == "kohm") quantity.scale = 1000;
    quantity.thermistor =
        read_thermistor(table.table("thermistor"), is_resistance);
    return quantity;
  }
  if (is_raw && (is_rate || is_temperature)) {
    quantity.scale = read_scale(table, is_rate ? "scale_deg_per_s" : "scale_K");
    if (is_temperature) quantity.shift = table.number("offset_degC");
    return quantity;
  }
  if (is_rate) static_cast<void>(table.has("scale_deg_per_s"));
  if (is_temperature)
    for (const char* key : {"scale_K", "offset_degC"})
      static_cast<void>(table.has(key));
  const UnitConversion conversion = unit_conversion(quantity.unit, units);
  quantity.offset += conversion.offset;
  quantity.scale = conversion.scale;
  return quantity;
}

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
