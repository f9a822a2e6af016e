// SPDX-License-Identifier: MIT
#include "dataset/files/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace beamgyro::internal {
namespace {

// Whether a number that no double holds is too large, not too small: the
// exponent of ten of its first digit tells.
bool is_too_large(std::string_view text) {
  const std::size_t mark = text.find_first_of("eE");
  const std::string_view digits = text.substr(0, mark);
  const std::size_t first = digits.find_first_of("123456789");
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const long long exponent =
      static_cast<long long>(point) - static_cast<long long>(first);
  if (mark == text.npos) return exponent > 0;
  std::string_view power = text.substr(mark + 1);
  if (power.starts_with('+')) power.remove_prefix(1);
  long long written = 0;
  const auto [end, error] =
      std::from_chars(power.data(), power.data() + power.size(), written);
  if (error == std::errc::result_out_of_range) return !power.starts_with('-');
  return exponent + written > 0;
}

}  // namespace

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error != std::errc::result_out_of_range) return value;
  return std::copysign(is_too_large(text) ? HUGE_VAL : 0.0,
                       text.starts_with('-') ? -1.0 : 1.0);
}

}  // namespace beamgyro::internal
