// SPDX-License-Identifier: MIT
#include "dataset/log/log_clock.h"

#include <fmt/format.h>

namespace beamgyro {

LogClock::LogClock(LogNumbers& log, const LogTime& time)
    : log_(log), time_(time) {
  if (time.column) slot_ = log.slot(*time.column);
}

std::optional<LogTicks> LogClock::read() {
  LogTicks ticks;
  if (slot_) {
    ticks.count = log_.whole_in(*slot_);
  } else {
    ticks.count = row_++;
  }
  if (ticks.count) {
    if (time_.wrap_bits > 0) ticks.count = unwrapped(*ticks.count);
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

std::int64_t LogClock::unwrapped(std::int64_t count) {
  const std::int64_t range = std::int64_t{1} << time_.wrap_bits;
  if (count < 0 || count >= range) {
    log_.fail(*slot_,
              fmt::format("is no count of {} bits (wrap_bits in the map)",
                          time_.wrap_bits),
              fmt::format("a whole number from 0 to {}", range - 1));
  }
  const std::int64_t step = count - before_.value_or(count);
  if (step < -range / 2) turns_ += range;
  if (step > range / 2) turns_ -= range;
  before_ = count;
  return count + turns_;
}

double LogClock::time(const LogTicks& first, const LogTicks& ticks) const {
  const double since = first.count && ticks.count
                           ? static_cast<double>(*ticks.count - *first.count)
                           : ticks.value - first.value;
  const double rate = time_.ticks_per_s;
  return time_.offset ? (first.value + since) / rate + *time_.offset
                      : since / rate;
}

void LogClock::fail(const std::string& message) const {
  if (slot_) log_.text().fail(*slot_, message);
  log_.text().fail_row(message);
}

}  // namespace beamgyro
