// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "config/range.h"
#include "config/table.h"
#include "dataset/log/log_date.h"
#include "dataset/log/thermistor.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {

/// A column of a log, by its name in the line of names or by its number.
struct LogColumn {
  std::string name;
  std::size_t number = 0;  // from 1; 0: by name
  std::string place;       // of the key in the map, for messages
};

/// One variable of a recording, and the conversion of a number of the log to
/// its value:
///   value = (raw - offset) scale + shift,
/// `raw` is first read as two's complement of `wrap_bits` bits, if that is set.
struct LogQuantity {
  RecordedSignal signal;
  LogColumn column;
  std::string unit;        // of the log, as the map states it
  std::string unit_place;  // of that key in the map
  double offset = 0;       // [unit]
  double scale = 1;        // [units per unit]
  double shift = 0;        // [units]
  int wrap_bits = 0;       // 0: not wrapped
  std::optional<Thermistor> thermistor = {};  // in place of the equation above
  Range plausible = any();
  bool joined = false;  // from the log that the map joins

  /// Returns whether `raw` is a whole number of `wrap_bits` bits; true if that
  /// is not set.
  bool fits(double raw) const;
  double value(double raw) const;
};

/// Reads the key `column` of a table, or another one: a text is a name, an
/// integer is a number.
LogColumn read_log_column(const ConfigTable& table,
                          std::string_view key = "column");

/// Reads the keys `column` and `unit` of a signal, and the keys that the unit
/// requires: of an angular rate in deg/s, rad/s, V, mV or counts; of a
/// temperature in degC, degF, K, V, mV or counts; of a number in a multiple of
/// its unit. Throws std::invalid_argument that names the key for a unit that is
/// missing or unknown, and as ConfigTable.
LogQuantity read_log_quantity(const ConfigTable& table,
                              std::string_view signal);

/// A time in the unit of the log. Whole numbers keep every digit: nanoseconds
/// since 1970 do not fit into a double.
struct LogTicks {
  double value = 0;
  std::optional<std::int64_t> count;  // when it is a whole number

  /// Returns this - other, in ticks.
  double since(const LogTicks& other) const {
    return count && other.count ? static_cast<double>(*count - *other.count)
                                : value - other.value;
  }
};

/// Defines the times of the rows:
///   time = seconds(ticks - zero) + offset,
///   seconds(ticks) = ticks / ticks_per_s * tick_s.
/// Ticks are the number in `column`, the nanoseconds of the date-time in it, or
/// the number of the row from 0. Without a zero and an offset the first row is
/// at 0. Rows outside [from, to) are left out.
struct LogTime {
  std::optional<LogColumn> column;
  std::optional<LogColumn> date_column;  // its cell and a blank come first
  std::optional<DateFormat> format;      // of a column of date-times
  double ticks_per_s = 1;                // [1/s], 1 where tick_s is not 1
  double tick_s = 1;                     // [s], of a unit longer than 1 s
  std::optional<double> offset;          // [s]
  std::optional<LogTicks> zero, from, to;
  int wrap_bits = 0;  // the column starts over at 2^wrap_bits; 0: no
  std::string unit;   // as the map states it; empty: date-times or no column
  std::string place;  // of the unit, the format or the rate in the map

  double seconds(double ticks) const { return ticks / ticks_per_s * tick_s; }
};

/// Returns a whole number of ticks. `count` is less than 2^62.
LogTicks whole_ticks(std::int64_t count);

/// Reads the table `time` of a map. Throws std::invalid_argument for an unknown
/// or wrong key.
LogTime read_log_time(const ConfigTable& table);

}  // namespace beamgyro::internal
