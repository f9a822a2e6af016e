// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro {

/// Line and column in a file, both from 1.
struct FilePosition {
  std::size_t line = 1, column = 1;
  auto operator<=>(const FilePosition&) const = default;
};

/// One value of a TOML document with what it needs to be blamed for: its key,
/// its place, and the override it came from.
struct ConfigNode {
  enum class Kind { kTable, kArray, kText, kInteger, kFloat, kFlag, kDate };

  Kind kind = Kind::kTable;
  std::string text;                  // kText
  long integer = 0;                  // kInteger
  double number = 0.0;               // kFloat
  bool flag = false;                 // kFlag
  std::vector<ConfigNode> children;  // kTable in file order, kArray

  std::string key;            // empty for the root and for array elements
  FilePosition key_position;  // of the key or of the table's header
  FilePosition position;      // of the value

  std::optional<std::size_t> origin;  // index of the override that gave it
  bool bridge = false;  // table made only to hold an override's key

  mutable bool known = false;  // somebody read it
};

ConfigNode* find_child(ConfigNode& table, std::string_view key);
const ConfigNode* find_child(const ConfigNode& table, std::string_view key);

/// The value as one line for a message: `-0.04`, `"abc"`, `an array of 3`.
std::string text_of(const ConfigNode& node);

/// The value in TOML syntax on one line; numbers in the fewest digits that read
/// back as the same number. kDate has none: an empty text.
std::string toml_text(const ConfigNode& node);

/// A number as a value of a document.
ConfigNode number_node(double number);

/// Text without control characters and of bounded length, for a message.
std::string printable(std::string_view text);

}  // namespace beamgyro
