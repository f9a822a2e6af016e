// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "config/config_node.h"
#include "config/overrides.h"

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

}  // namespace beamgyro::internal
