// SPDX-License-Identifier: MIT
/// \file
/// Values of the keys of files, in the types of C++.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// A value of a key: true or false, a whole number, a number, a text, or an
/// array of these, which may be nested. It is in the unit that the name of the
/// key ends in.
class Value {
 public:
  template <std::same_as<bool> T>
  Value(T flag) : toml_(flag ? "true" : "false") {}
  template <std::integral T>
  requires(!std::same_as<T, bool>) Value(T number)
      : toml_(std::to_string(number)) {}
  Value(double number);
  Value(std::nullptr_t) = delete;
  /// A text, without the quotes of TOML.
  template <class T>
  requires std::convertible_to<const T&, std::string_view> Value(const T& text)
      : toml_(quoted(text)) {}
  template <class T>
  Value(const std::vector<T>& items) : Value(array_of(items)) {}
  /// An array, as in {0.0, 60.0} and {{0.0, 25.0}, {60.0, 30.0}}.
  Value(std::initializer_list<Value> items) : Value(array_of(items)) {}

  /// Returns it in TOML syntax. Numbers have the fewest digits that read back
  /// as the same number.
  const std::string& toml() const { return toml_; }

 private:
  struct Toml {
    std::string text;
  };
  explicit Value(Toml toml) : toml_(std::move(toml.text)) {}
  static std::string quoted(std::string_view text);
  template <class Items>
  static Toml array_of(const Items& items) {
    std::string text;
    for (const auto& item : items)
      text.append(text.empty() ? "" : ", ").append(Value(item).toml_);
    return {"[" + text + "]"};
  }

  std::string toml_;
};

/// Returns KEY=VALUE, as the functions with `overrides` take it. `key` is
/// dotted, as "beam.length_m". Throws OptionError for a text that is no key;
/// what takes the override says which values are right.
std::string override_of(std::string_view key, const Value& value);

}  // namespace beamgyro
