// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/range.h"

namespace beamgyro::internal {

struct ConfigNode;
struct ConfigValue;
struct DocumentState;

/// One table of a checked TOML document. Reading a key marks it as known;
/// ConfigDocument::reject_unknown_keys() rejects the others. A table keeps its
/// document alive. Every error is a std::invalid_argument "file:line:column:
/// table.key: value met, what is wrong; what would be right". For a value that
/// came from an override the place is "set KEY=VALUE", spelled as in
/// OptionError.
class ConfigTable {
 public:
  /// Returns whether the key is there. This does not count as reading it, so a
  /// key that is never read is rejected in the end.
  bool has(std::string_view key) const;
  /// Returns whether the key is there and holds a number. This does not count
  /// as reading it either.
  bool holds_number(std::string_view key) const;

  /// Reads an integer or a float. NaN and infinities are rejected.
  double number(std::string_view key, const Range& range = any()) const;
  double number_or(std::string_view key, double otherwise,
                   const Range& range = any()) const;
  std::optional<double> optional_number(std::string_view key,
                                        const Range& range = any()) const;
  /// Reads an integer in [low, high].
  long integer(std::string_view key, long low, long high) const;
  long integer_or(std::string_view key, long otherwise, long low,
                  long high) const;
  bool flag(std::string_view key) const;
  bool flag_or(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key) const;
  std::string text_or(std::string_view key, std::string_view otherwise) const;
  std::optional<std::string> optional_text(std::string_view key) const;
  /// Reads one of the texts `allowed`.
  std::string choice(std::string_view key,
                     const std::vector<std::string>& allowed) const;
  std::string choice_or(std::string_view key, std::string_view otherwise,
                        const std::vector<std::string>& allowed) const;

  /// Reads an array of any length, with every number in `range`.
  std::vector<double> numbers(std::string_view key,
                              const Range& range = any()) const;
  std::vector<double> numbers(std::string_view key, std::size_t count,
                              const Range& range = any()) const;
  std::vector<long> integers(std::string_view key, long low, long high) const;
  std::vector<std::string> texts(std::string_view key) const;
  /// Reads an array of arrays of `width` numbers: [[a, b], ...].
  std::vector<std::vector<double>> rows(std::string_view key,
                                        std::size_t width) const;

  /// Returns the keys in file order. This does not count as reading them.
  std::vector<std::string> keys() const;
  /// Reads a value of any type, with everything in it.
  const ConfigNode& value(std::string_view key) const;
  /// Reads an array of tables, [[key]]; returns none when the key is absent.
  std::vector<ConfigTable> tables(std::string_view key) const;

  ConfigTable table(std::string_view key) const;
  std::optional<ConfigTable> optional_table(std::string_view key) const;
  /// Returns a table without keys when the key is absent.
  ConfigTable table_or_empty(std::string_view key) const;

  /// Returns "file:line:column" of the value, or of the nearest table above it
  /// when the key is absent.
  std::string position(std::string_view key) const;
  /// Returns "file:line:column: table.key" of the value, or of the nearest
  /// table above it when the key is absent.
  std::string place(std::string_view key) const;
  /// The same for one element of an array: "file:line:column: table.key[3]".
  std::string place(std::string_view key, std::size_t index) const;
  /// Throws std::invalid_argument "place(key): message".
  [[noreturn]] void fail(std::string_view key,
                         const std::string& message) const;
  [[noreturn]] void fail(std::string_view key, std::size_t index,
                         const std::string& message) const;

 private:
  friend class ConfigDocument;
  ConfigTable(std::shared_ptr<DocumentState> document, const ConfigNode& node,
              std::string path, bool present);

  std::string path_of(std::string_view key) const;
  const ConfigNode* peek(std::string_view key) const;
  std::optional<ConfigValue> find(std::string_view key) const;
  ConfigValue require(std::string_view key, const std::string& expected) const;
  [[noreturn]] void fail_missing(std::string_view key,
                                 const std::string& expected) const;

  std::shared_ptr<DocumentState> document_;
  const ConfigNode* node_;  // of an absent table: the nearest one above it
  std::string path_;        // dotted, empty for the root
  bool present_;
};

}  // namespace beamgyro::internal
