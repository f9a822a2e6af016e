// SPDX-License-Identifier: MIT
#include "dataset/log/log_date.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

constexpr std::array<std::string_view, 12> kMonths = {
    "jan", "feb", "mar", "apr", "may", "jun",
    "jul", "aug", "sep", "oct", "nov", "dec"};
constexpr int kFirstYear = 1900,
              kLastYear = 2100;  // any two are < 2^63 ns apart
constexpr int kPivot = 69;       // %y: 69..99 are of the 20th century

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_space(char c) { return c == ' ' || c == '\t'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

// What a text states, part by part.
struct DateParts {
  int year = 1970, month = 1, day = 1, hour = 0, minute = 0, second = 0;
  std::int64_t nanoseconds = 0;
  int zone = 0;           // [min], local time - UTC
  int half = -1;          // 0: AM, 1: PM
  bool half_day = false;  // the hour is one of 12

  std::optional<std::int64_t> since_1970() const {
    int hours = hour;
    if (half_day) {
      if (hour < 1 || hour > 12) return std::nullopt;
      hours = hour % 12 + (half == 1 ? 12 : 0);
    }
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(unsigned(month)),
                                           std::chrono::day(unsigned(day))};
    if (year < kFirstYear || year > kLastYear || !date.ok() || hours > 23 ||
        minute > 59 || second > 60)
      return std::nullopt;
    const std::int64_t days =
        std::chrono::sys_days(date).time_since_epoch().count();
    const std::int64_t seconds =
        ((days * 24 + hours) * 60 + minute - zone) * 60 + second;
    return seconds * kNanosecondsPerSecond + nanoseconds;
  }
};

// Takes one part after the other from the front of a text. Each function
// returns whether it was there.
class DateScanner {
 public:
  explicit DateScanner(std::string_view text)
      : at_(text.data()), end_(text.data() + text.size()) {}

  bool over() const { return at_ == end_; }

  bool digits(int& value, int least, int most) {
    int count = 0;
    for (value = 0; count < most && !over() && is_digit(*at_); ++count)
      value = 10 * value + (*at_++ - '0');
    return count >= least;
  }

  bool literal(char c) {
    if (over() || *at_ != c) return false;
    ++at_;
    return true;
  }

  bool blanks() {
    const char* const before = at_;
    while (!over() && is_space(*at_)) ++at_;
    return at_ != before;
  }

  bool fraction(std::int64_t& nanoseconds) {
    std::int64_t unit = kNanosecondsPerSecond;
    const char* const before = at_;
    nanoseconds = 0;
    for (; !over() && is_digit(*at_); ++at_) {
      unit /= 10;
      nanoseconds += unit * (*at_ - '0');
    }
    return at_ != before;
  }

  // A second, with the fraction after it if there is one.
  bool second(DateParts& parts, bool with_fraction) {
    if (!digits(parts.second, 1, 2)) return false;
    const bool marked = with_fraction && !over() &&
                        (*at_ == '.' || *at_ == ',') && end_ - at_ > 1 &&
                        is_digit(at_[1]);
    if (!marked) return true;
    ++at_;
    return fraction(parts.nanoseconds);
  }

  // Z, +hh, +hhmm or +hh:mm.
  bool zone(int& minutes) {
    if (literal('Z') || literal('z')) return true;
    const bool west = !over() && *at_ == '-';
    if (!literal('+') && !literal('-')) return false;
    int hour = 0, minute = 0;
    if (!digits(hour, 2, 2)) return false;
    if (literal(':') || (!over() && is_digit(*at_)))
      if (!digits(minute, 2, 2)) return false;
    minutes = (west ? -1 : 1) * (60 * hour + minute);
    return hour < 24 && minute < 60;
  }

  bool month_name(int& month) {
    if (end_ - at_ < 3) return false;
    const std::array<char, 3> name = {lower(at_[0]), lower(at_[1]),
                                      lower(at_[2])};
    const auto* const found = std::find(kMonths.begin(), kMonths.end(),
                                        std::string_view(name.data(), 3));
    if (found == kMonths.end()) return false;
    month = static_cast<int>(found - kMonths.begin()) + 1;
    at_ += 3;
    return true;
  }

  bool half(int& half) {
    if (end_ - at_ < 2 || lower(at_[1]) != 'm') return false;
    const char first = lower(at_[0]);
    half = first == 'p' ? 1 : 0;
    at_ += 2;
    return first == 'a' || first == 'p';
  }

 private:
  const char *at_, *end_;
};

bool scan_iso(DateScanner& scan, DateParts& parts) {
  if (!scan.digits(parts.year, 4, 4)) return false;
  if (!scan.literal('-') || !scan.digits(parts.month, 2, 2)) return false;
  if (!scan.literal('-') || !scan.digits(parts.day, 2, 2)) return false;
  if (scan.over()) return true;
  if (!scan.literal('T') && !scan.literal('t') && !scan.blanks()) return false;
  if (!scan.digits(parts.hour, 2, 2)) return false;
  if (!scan.literal(':') || !scan.digits(parts.minute, 2, 2)) return false;
  if (scan.literal(':') && !scan.second(parts, true)) return false;
  if (scan.over()) return true;
  scan.blanks();
  return scan.zone(parts.zone);
}

bool scan_letter(char letter, DateScanner& scan, DateParts& parts,
                 bool second_has_fraction) {
  switch (letter) {
    case 'Y':
      return scan.digits(parts.year, 4, 4);
    case 'y':
      if (!scan.digits(parts.year, 2, 2)) return false;
      parts.year += parts.year < kPivot ? 2000 : 1900;
      return true;
    case 'm':
      return scan.digits(parts.month, 1, 2);
    case 'b':
      return scan.month_name(parts.month);
    case 'd':
      return scan.digits(parts.day, 1, 2);
    case 'I':
      parts.half_day = true;
      return scan.digits(parts.hour, 1, 2);
    case 'H':
      return scan.digits(parts.hour, 1, 2);
    case 'p':
      return scan.half(parts.half);
    case 'M':
      return scan.digits(parts.minute, 1, 2);
    case 'S':
      return scan.second(parts, second_has_fraction);
    case 'f':
      return scan.fraction(parts.nanoseconds);
    case 'z':
      return scan.zone(parts.zone);
    default:
      return scan.literal('%');
  }
}

}  // namespace

DateFormat::DateFormat(const std::string& pattern)
    : pattern_(pattern), is_iso_(pattern == "iso") {
  if (is_iso_) return;
  std::string letters;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') continue;
    const char letter = ++i < pattern.size() ? pattern[i] : ' ';
    if (std::string_view("YymbdHIpMSfz%").find(letter) == std::string::npos) {
      throw std::invalid_argument(fmt::format(
          "%{} is not known; expected %Y, %y, %m, %b, %d, %H, %I, %p, %M, %S, "
          "%f, %z or %%",
          letter));
    }
    letters += letter;
  }
  const auto has = [&](const char* any_of) {
    return letters.find_first_of(any_of) != std::string::npos;
  };
  has_fraction_ = has("f");
  has_date_ = has("Yymbd");
  const bool whole_date = has("Yy") && has("mb") && has("d");
  if (has_date_ ? !whole_date : !has("HI")) {
    throw std::invalid_argument(
        "is no form of a date or time; expected \"iso\", or year, month and "
        "day, or the time of the day, such as \"%d.%m.%Y %H:%M:%S\"");
  }
  if (has("I") != has("p"))
    throw std::invalid_argument("expected %p (AM or PM) exactly with %I");
}

std::string DateFormat::example() const {
  if (is_iso_) return "2026-03-05T14:07:09.25";
  std::string text;
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    if (pattern_[i] != '%') {
      text += pattern_[i];
      continue;
    }
    constexpr std::string_view kLetters = "YymbdHIpMSfz%";
    constexpr std::array<std::string_view, 13> kParts = {
        "2026", "26", "03", "Mar", "05",     "14", "02",
        "PM",   "07", "09", "25",  "+01:00", "%"};
    text += kParts[kLetters.find(pattern_[++i])];
  }
  return text;
}

std::optional<std::int64_t> DateFormat::read(std::string_view text) const {
  DateScanner scan(text);
  DateParts parts;
  if (is_iso_) {
    if (!scan_iso(scan, parts) || !scan.over()) return std::nullopt;
    return parts.since_1970();
  }
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    const char c = pattern_[i];
    const bool found =
        c == '%'   ? scan_letter(pattern_[++i], scan, parts, !has_fraction_)
        : c == ' ' ? scan.blanks()
                   : scan.literal(c);
    if (!found) return std::nullopt;
  }
  if (!scan.over()) return std::nullopt;
  return parts.since_1970();
}

bool looks_like_date(std::string_view text) {
  if (text.empty() || !is_digit(text.front())) return false;
  const auto count = [text](std::string_view marks) {
    return std::count_if(text.begin(), text.end(), [marks](char c) {
      return marks.find(c) != std::string_view::npos;
    });
  };
  return count(":") > 0 || count("-/.") >= 2;
}

}  // namespace beamgyro::internal
