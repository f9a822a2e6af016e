// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace beamgyro::internal {

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
constexpr std::int64_t kNanosecondsPerDay = 86400 * kNanosecondsPerSecond;

/// Form of the date-times of a log: "iso" for ISO 8601 (2026-03-05T14:07:09.25,
/// a blank for the T, seconds and zone may be missing), or a pattern in the
/// letters of strptime():
///   %Y year, %y its last two digits, %m month, %b its English name, %d day,
///   %H hour, %I hour of 12 with %p AM or PM, %M minute, %S second with the
///   fraction that follows it, %f a fraction of its own, %z zone, %% a '%'.
/// A blank stands for one or more blanks, any other character for itself.
class DateFormat {
 public:
  /// Throws std::invalid_argument for an unknown letter, and for a pattern that
  /// has neither an hour nor a year with month and day.
  explicit DateFormat(const std::string& pattern);

  const std::string& pattern() const { return pattern_; }
  /// Returns whether texts of this form hold a date; otherwise they are a time
  /// of the day.
  bool has_date() const { return has_date_; }
  std::string example() const;  // a text of this form, for messages

  /// Returns the time since 1970-01-01 00:00 UTC, or since midnight, in ns.
  /// Returns nothing for a text of another form and for a date that does not
  /// exist. A text without a zone is taken as UTC. Digits beyond ns are left
  /// out.
  std::optional<std::int64_t> read(std::string_view text) const;

 private:
  std::string pattern_;
  bool is_iso_, has_date_ = true, has_fraction_ = false;
};

/// Returns whether a text looks like a date or a time of the day.
bool looks_like_date(std::string_view text);

}  // namespace beamgyro::internal
