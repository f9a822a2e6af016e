// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "dataset/log/log_column.h"
#include "dataset/log/log_numbers.h"

namespace beamgyro::internal {

/// Converts the numbers or date-times of a column, or the numbers of the rows,
/// to times (LogTime).
class LogClock {
 public:
  /// Both must outlive it. Throws as LogNumbers::slot().
  LogClock(LogNumbers& log, const LogTime& time);

  /// Returns the ticks of the present row, or nothing when they are missing. A
  /// column of wrap_bits bits that falls or rises by more than half of its
  /// range since the row before has wrapped around; so has a time of the day
  /// at midnight. Throws as LogNumbers::present().
  std::optional<LogTicks> read();
  void skip_row() { ++row_; }  // counts one that has no ticks

  /// Returns whether `ticks` are in [from, to).
  bool is_within(const LogTicks& ticks) const;
  /// Returns the time [s] of `ticks` when the first row is at `first`.
  double time(const LogTicks& first, const LogTicks& ticks) const;
  /// Returns the time [s] on the clock of the log, wherever it begins:
  ///   seconds(ticks - zero) + offset, both 0 when they are not set.
  double common_time(const LogTicks& ticks) const;
  /// Returns a bound of the rounding error of common_time() [s]. It grows with
  /// the readings, not with their difference: two seconds since 1970 that are
  /// printed with decimals are off by 1e-7 s each.
  double rounding(const LogTicks& ticks) const;

  /// Throws std::invalid_argument that names the cell of the time in the
  /// present row.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::optional<std::int64_t> read_date();
  void check_count(std::int64_t count) const;
  std::int64_t unwrapped(std::int64_t count);

  LogNumbers& log_;
  const LogTime& time_;
  std::optional<std::size_t> slot_, date_slot_;
  std::int64_t row_ = 0;                // number of the next row
  std::int64_t range_ = 0;              // ticks after which it starts over
  std::optional<std::int64_t> before_;  // count of the row before, as logged
  std::int64_t turns_ = 0;              // full ranges gone through, in ticks
  std::string text_;                    // of a date and a time
};

}  // namespace beamgyro::internal
