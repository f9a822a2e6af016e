// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Line and column in a file, both from 1.
struct FilePosition {
  std::size_t line = 1, column = 1;
  auto operator<=>(const FilePosition&) const = default;
};

/// One value of a TOML document, with what messages need: its key, its place,
/// and the override that it came from.
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

/// Returns the value as one line for a message: `-0.04`, `"abc"`, `an array of
/// 3`.
std::string text_of(const ConfigNode& node);

/// Returns the value in TOML syntax on one line. Numbers have the fewest digits
/// that read back as the same number. Returns an empty text for kDate.
std::string toml_text(const ConfigNode& node);

/// Returns a number as a value of a document.
ConfigNode number_node(double number);

/// Returns a text for a message: control characters are replaced, and the
/// length is bounded.
std::string printable(std::string_view text);

}  // namespace beamgyro::internal
