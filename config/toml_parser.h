// SPDX-License-Identifier: MIT
#pragma once

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

/// Parses a TOML document and returns its root table. Throws TomlError for text
/// that is not TOML or not UTF-8.
ConfigNode parse_toml(std::string_view text);

}  // namespace beamgyro::internal
