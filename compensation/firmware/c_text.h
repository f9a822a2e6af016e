// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro::internal {

/// Returns the shortest decimal C literal that reads back to the same float.
std::string c_literal(float value);

/// Returns a C identifier made from a file name. Characters that are neither
/// letter nor digit become _, and c_ is put before a name that does not start
/// with a letter.
std::string c_identifier(const std::string& text);

/// Returns `text` for a C comment. Characters other than letters, digits,
/// spaces and ().,:;+-=% become _, so that the text cannot end the comment.
std::string c_comment(const std::string& text);

/// Returns the C string literal of printable ASCII characters.
std::string c_string(std::string_view text);

}  // namespace beamgyro::internal
