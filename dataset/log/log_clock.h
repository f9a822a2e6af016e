// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "dataset/log/log_map.h"
#include "dataset/log/log_numbers.h"

namespace beamgyro {

/// A time in the unit of the log. Whole numbers keep every digit: nanoseconds
/// since 1970 do not fit into a double.
struct LogTicks {
  double value = 0;
  std::optional<std::int64_t> count;  // when it is a whole number
};

/// Converts the numbers of the rows or of a column to times (LogTime).
class LogClock {
 public:
  /// Both must outlive it. Throws as LogNumbers::slot().
  LogClock(LogNumbers& log, const LogTime& time);

  /// Returns the ticks of the present row, or nothing when they are missing. A
  /// column of wrap_bits bits that falls or rises by more than half of its
  /// range since the row before has wrapped around. Throws as
  /// LogNumbers::present().
  std::optional<LogTicks> read();
  void skip_row() { ++row_; }  // counts one that has no ticks

  /// Returns the time [s] of `ticks` when the first row is at `first`.
  double time(const LogTicks& first, const LogTicks& ticks) const;

  /// Throws std::invalid_argument that names the cell of the time in the
  /// present row.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::int64_t unwrapped(std::int64_t count);

  LogNumbers& log_;
  const LogTime& time_;
  std::optional<std::size_t> slot_;
  std::int64_t row_ = 0;                // number of the next row
  std::optional<std::int64_t> before_;  // count of the row before, as logged
  std::int64_t turns_ = 0;              // full ranges gone through, in ticks
};

}  // namespace beamgyro
