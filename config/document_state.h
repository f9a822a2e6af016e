// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_node.h"
#include "config/override_set.h"

namespace beamgyro::internal {

/// State that a document shares with its tables.
struct DocumentState {
  std::filesystem::path path;
  std::string name;  // in messages
  std::string text;  // byte for byte as read
  ConfigNode root;
  std::shared_ptr<const ConfigNode> file_root;  // before the overrides
  std::set<std::string> known_keys;  // dotted keys somebody asked for
  std::shared_ptr<OverrideSet> overrides;

  /// Records that the key `path` was asked for.
  void note_known(const std::string& path);
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
