// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "config/config_node.h"

namespace beamgyro::internal {

/// Thrown for text that is not TOML: what is wrong, and where.
struct TomlError : std::runtime_error {
  TomlError(const std::string& message, FilePosition where)
      : std::runtime_error(message), position(where) {}
  FilePosition position;
};

/// The largest file that is read as TOML [bytes].
inline constexpr std::size_t kLargestToml = std::size_t{16} << 20;

/// Checks a text before the parser reads it. Throws TomlError for a text
/// - of more than kLargestToml bytes;
/// - with more than 500,000 keys and values, because the parser takes 400 bytes
///   for each;
/// - in which keys, tables and arrays are nested deeper than 256, because the
///   parser destroys its result by recursion.
void check_toml_extent(std::string_view text);

/// Parses a TOML document and returns its root table. Throws TomlError for text
/// that is not TOML or not UTF-8.
ConfigNode parse_toml(std::string_view text);

}  // namespace beamgyro::internal
