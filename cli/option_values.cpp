// SPDX-License-Identifier: MIT
#include "cli/option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "config/suggestion.h"
#include "include/beamgyro/validate.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& reason,
                             const std::string& expected) {
  throw std::invalid_argument(
      fmt::format("{} {}: {}; expected {}", option, text, reason, expected));
}

/// Reads the whole text as a number. Returns what is wrong, or nothing.
template <class Number>
std::string read_all(const std::string& text, Number& number,
                     const char* kind) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (stop != end || error == std::errc::invalid_argument)
    return fmt::format("not {}", kind);
  return error == std::errc() ? "" : "out of range";
}

}  // namespace

long whole_number(const std::string& option, const std::string& text, long low,
                  long high) {
  long number = 0;
  std::string wrong = read_all(text, number, "a whole number");
  if (wrong.empty() && (number < low || number > high)) wrong = "out of range";
  if (!wrong.empty())
    fail_value(option, text, wrong,
               fmt::format("a whole number from {} to {}", low, high));
  return number;
}

std::uint64_t seed_or_random(const std::string& option,
                             const std::string& text) {
  if (text == "random") return random_seed();
  std::uint64_t seed = 0;
  std::string wrong = read_all(text, seed, "a seed");
  if (wrong.empty() && seed > kLargestSeed) wrong = "out of range";
  if (!wrong.empty())
    fail_value(
        option, text, wrong,
        fmt::format("random, or a whole number from 0 to {}", kLargestSeed));
  return seed;
}

double decimal_number(const std::string& option, const std::string& text,
                      const Range& range) {
  double number = 0;
  std::string wrong = read_all(text, number, "a number");
  if (wrong.empty() && !std::isfinite(number)) wrong = "not finite";
  if (wrong.empty() && !range.contains(number)) wrong = "out of range";
  if (!wrong.empty()) fail_value(option, text, wrong, text_of(range));
  return number;
}

std::string one_of(const std::string& option, const std::string& text,
                   const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, text) != allowed.end()) return text;
  const std::string near = suggestion(text, allowed);
  fail_value(
      option, text, "not known",
      fmt::format(
          "{}{}", fmt::join(allowed, ", "),
          near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

std::vector<double> numbers_between(const std::string& text, char separator) {
  std::vector<double> values;
  const char* place = text.data();
  const char* const end = place + text.size();
  while (true) {
    while (place != end && *place == ' ') ++place;
    double value = 0;
    const auto [stop, error] = std::from_chars(place, end, value);
    if (error != std::errc()) return {};
    values.push_back(value);
    place = stop;
    while (place != end && (*place == ' ' || *place == '\r')) ++place;
    if (place == end) return values;
    if (*place != separator) return {};
    ++place;
  }
}

std::pair<double, double> temperature_range(const std::string& option,
                                            const std::string& text) {
  const std::vector<double> ends = numbers_between(text, ':');
  if (ends.size() == 2) return {ends[0], ends[1]};
  throw std::invalid_argument(fmt::format(
      "{} {}: not a range; expected LOW:HIGH in degC", option, text));
}

}  // namespace beamgyro::internal
