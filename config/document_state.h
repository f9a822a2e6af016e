// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_node.h"
#include "config/overrides.h"
#include "config/range.h"

namespace beamgyro::internal {

struct Override {
  std::string argument;           // KEY=VALUE as given
  std::vector<std::string> path;  // KEY split at its dots
  ConfigNode value;
  std::string place;  // for messages; empty: the argument
  mutable bool used = false;
};

struct OverrideSet {
  std::vector<Override> overrides;
  std::set<std::string> known_keys;  // dotted keys some document asked for
};

/// Puts the value of `set` into the tree below `root`. It replaces or creates
/// the key and its parent tables. `origin` is its index among the overrides;
/// `document` names the tree in errors. Throws std::invalid_argument when the
/// path runs through a value that is not a table.
void insert_override(const Override& set, std::size_t origin,
                     const std::string& document, ConfigNode& root);

/// A number that was read from a document.
struct NumberRead {
  std::string key;  // dotted; of an element of an array "key[0]"
  double value;
  Range range;         // in which it must lie
  bool whole = false;  // read as an integer
};

/// State that a document shares with its tables.
struct DocumentState {
  std::filesystem::path path;
  std::string name;  // in messages
  std::string text;  // byte for byte as read
  ConfigNode root;
  std::shared_ptr<const ConfigNode> file_root;  // before the overrides
  std::set<std::string> known_keys;  // dotted keys somebody asked for
  std::shared_ptr<OverrideSet> overrides;
  std::vector<NumberRead>* numbers = nullptr;  // where they are noted

  /// Records that the key `path` was asked for.
  void note_known(const std::string& path);
  /// Notes a number where somebody collects them.
  void note_number(const std::string& key, double value, const Range& range,
                   bool whole) const;
  /// Records that `node` was read.
  void mark_read(const ConfigNode& node) const;
  /// Returns "file:line:column", or "set KEY=VALUE" for a value that came from
  /// an override.
  std::string place(const ConfigNode& node, FilePosition position) const;
  /// Throws std::invalid_argument "place: message", an OptionError for a value
  /// that came from an override.
  [[noreturn]] void fail(const ConfigNode& node, FilePosition position,
                         const std::string& message) const;
  /// Returns the keys asked for in the table `path`, without the path.
  std::vector<std::string> known_keys_in(const std::string& path) const;
  /// Throws std::invalid_argument for the first key in file order that was not
  /// read.
  void reject_unknown_keys() const;
};

std::string joined(const std::string& table, std::string_view key);

}  // namespace beamgyro::internal
