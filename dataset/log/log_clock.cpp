// SPDX-License-Identifier: MIT
#include "dataset/log/log_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/config_node.h"

namespace beamgyro::internal {

LogClock::LogClock(LogNumbers& log, const LogTime& time)
    : log_(log), time_(time) {
  if (time.column) slot_ = log.slot(*time.column);
  if (time.date_column) date_slot_ = log.slot(*time.date_column);
  if (time.wrap_bits > 0) range_ = std::int64_t{1} << time.wrap_bits;
  if (time.format && !time.format->has_date()) range_ = kNanosecondsPerDay;
}

std::optional<LogTicks> LogClock::read() {
  LogTicks ticks;
  if (!slot_) {
    ticks.count = row_++;
  } else if (time_.format) {
    ticks.count = read_date();
    if (!ticks.count) return std::nullopt;
  } else {
    ticks.count = log_.whole_in(*slot_);
    if (ticks.count && time_.wrap_bits > 0) check_count(*ticks.count);
  }
  if (ticks.count) {
    if (range_ > 0) ticks.count = unwrapped(*ticks.count);
    ticks.value = static_cast<double>(*ticks.count);
    return ticks;
  }
  const std::optional<double> number = log_.present(*slot_);
  if (!number) return std::nullopt;
  if (time_.wrap_bits > 0) {
    log_.fail(*slot_, "is no whole number", "a count (wrap_bits in the map)");
  }
  ticks.value = *number;
  return ticks;
}

std::optional<std::int64_t> LogClock::read_date() {
  if (log_.is_absent(*slot_)) return std::nullopt;
  std::string_view text = log_.text().cell(*slot_);
  if (date_slot_) {
    if (log_.is_absent(*date_slot_)) return std::nullopt;
    text_ = log_.text().cell(*date_slot_);
    text_ += ' ';
    text_ += text;
    text = text_;
  }
  const std::optional<std::int64_t> count = time_.format->read(text);
  if (!count) {
    log_.text().fail(
        *slot_,
        fmt::format("{} is no time of the form \"{}\" or does not exist; "
                    "expected one such as {} (or another {})",
                    shown_cell(text), printable(time_.format->pattern()),
                    printable(time_.format->example()), time_.place));
  }
  return count;
}

void LogClock::check_count(std::int64_t count) const {
  if (count >= 0 && count < range_) return;
  log_.fail(*slot_,
            fmt::format("is no count of {} bits (wrap_bits in the map)",
                        time_.wrap_bits),
            fmt::format("a whole number from 0 to {}", range_ - 1));
}

std::int64_t LogClock::unwrapped(std::int64_t count) {
  const std::int64_t step = count - before_.value_or(count);
  if (step < -range_ / 2) turns_ += range_;
  if (step > range_ / 2) turns_ -= range_;
  constexpr std::int64_t kMost = std::int64_t{1} << 61;
  if (turns_ > kMost || turns_ < -kMost)
    log_.fail(*slot_, "has started over too often", "times of one log");
  before_ = count;
  return count + turns_;
}

bool LogClock::is_within(const LogTicks& ticks) const {
  return (!time_.from || ticks.since(*time_.from) >= 0) &&
         (!time_.to || ticks.since(*time_.to) < 0);
}

double LogClock::time(const LogTicks& first, const LogTicks& ticks) const {
  if (time_.zero) return common_time(ticks);
  const double since = ticks.since(first);
  return time_.offset ? time_.seconds(first.value + since) + *time_.offset
                      : time_.seconds(since);
}

double LogClock::common_time(const LogTicks& ticks) const {
  return time_.seconds(ticks.since(time_.zero.value_or(whole_ticks(0)))) +
         time_.offset.value_or(0);
}

double LogClock::rounding(const LogTicks& ticks) const {
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  const LogTicks zero = time_.zero.value_or(whole_ticks(0));
  const bool exact = ticks.count && zero.count;
  const double reading =
      exact ? std::abs(ticks.since(zero))
            : std::max(std::abs(ticks.value), std::abs(zero.value));
  return kRounding *
         (time_.seconds(reading) + std::abs(time_.offset.value_or(0)));
}

void LogClock::fail(const std::string& message) const {
  if (slot_) log_.text().fail(*slot_, message);
  log_.text().fail_row(message);
}

}  // namespace beamgyro::internal
