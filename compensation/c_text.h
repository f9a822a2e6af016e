// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro {

/// Shortest decimal literal of C that reads back to the same single.
std::string c_literal(float value);

/// A C identifier from a file name: what is neither letter nor digit becomes _,
/// and c_ comes before one that would not start with a letter.
std::string c_identifier(const std::string& text);

/// `text` as it may stand in a comment of C: anything but letters, digits,
/// spaces and ().,:;+-=% becomes _, so that nothing ends the comment.
std::string c_comment(const std::string& text);

}  // namespace beamgyro
