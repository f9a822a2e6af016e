// SPDX-License-Identifier: MIT
#include "compensation/firmware/c_text.h"

#include <fmt/format.h>

#include <string_view>

namespace beamgyro::internal {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

bool has_character(std::string_view characters, char c) {
  return characters.find(c) != std::string_view::npos;
}

std::string with_underscores(const std::string& text, std::string_view others) {
  std::string result = text;
  for (char& c : result)
    if (!has_character(kLetters, c) && !has_character(kDigits, c) &&
        !has_character(others, c))
      c = '_';
  return result;
}

}  // namespace

std::string c_literal(float value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + "f";
}

std::string c_identifier(const std::string& text) {
  const std::string name = with_underscores(text, "");
  if (!name.empty() && has_character(kLetters, name[0])) return name;
  return fmt::format("c_{}", name);
}

// Without '*' a '/' neither ends a comment nor begins one within it.
std::string c_comment(const std::string& text) {
  return with_underscores(text, " ().,:;+-=%/");
}

std::string c_string(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    // Two question marks may begin a trigraph.
    if (c == '"' || c == '\\' || c == '?') literal += '\\';
    literal += c;
  }
  return literal + '"';
}

}  // namespace beamgyro::internal
