// SPDX-License-Identifier: MIT
/// \file
/// Errors about options, which each language spells in its own way.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// Returns how an option is written, with a value if that is not empty:
/// "soaks = 3" in C++, "--soaks 3" on the command line, "soaks=3" in Python.
/// `name` is that of the member of the options, such as "full_scale".
using OptionSpelling =
    std::function<std::string(std::string_view name, std::string_view value)>;

/// Options that contradict each other, miss one another or are out of range.
class OptionError : public std::invalid_argument {
 public:
  /// Composes the message from the spellings of the options in it.
  using Words = std::function<std::string(const OptionSpelling& spelled)>;

  explicit OptionError(Words words)
      : std::invalid_argument(words(in_cpp)), words_(std::move(words)) {}

  /// Puts words before those of an error, such as the name of a file.
  OptionError(const std::string& before, const std::invalid_argument& error)
      : OptionError(Words(
            [before, after = words_of(error)](const OptionSpelling& spelled) {
              return before + after(spelled);
            })) {}

  /// Returns the message for a reader who spells options in this way.
  std::string words(const OptionSpelling& spelled) const {
    return words_(spelled);
  }

  /// Returns "name", or "name = value".
  static std::string in_cpp(std::string_view name, std::string_view value) {
    std::string text(name);
    if (!value.empty()) text.append(" = ").append(value);
    return text;
  }

 private:
  static Words words_of(const std::invalid_argument& error) {
    const auto* of_options = dynamic_cast<const OptionError*>(&error);
    if (of_options != nullptr) return of_options->words_;
    return [text = std::string(error.what())](const OptionSpelling&) {
      return text;
    };
  }

  Words words_;
};

}  // namespace beamgyro
