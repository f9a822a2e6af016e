// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/table.h"
#include "dataset/log/log_date.h"
#include "dataset/log/log_quantity.h"

namespace beamgyro::internal {

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
