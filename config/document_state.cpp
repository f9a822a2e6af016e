// SPDX-License-Identifier: MIT
#include "config/document_state.h"

#include <fmt/format.h>

#include <stdexcept>

#include "config/suggestion.h"

namespace beamgyro::internal {
namespace {

struct UnknownKey {
  const ConfigNode* node = nullptr;
  std::string table;  // dotted path of the table it stands in
};

bool comes_before(const ConfigNode& a, const ConfigNode& b) {
  if (a.origin != b.origin) return a.origin < b.origin;  // the file first
  return a.key_position < b.key_position;
}

void find_first_unknown(const ConfigNode& table, const std::string& path,
                        UnknownKey& first);

// The elements of an array of tables that were read as such.
void find_in_tables(const ConfigNode& array, const std::string& path,
                    UnknownKey& first) {
  for (std::size_t i = 0; i < array.children.size(); ++i) {
    const ConfigNode& element = array.children[i];
    if (element.known && element.kind == ConfigNode::Kind::kTable)
      find_first_unknown(element, fmt::format("{}[{}]", path, i), first);
  }
}

void find_first_unknown(const ConfigNode& table, const std::string& path,
                        UnknownKey& first) {
  for (const ConfigNode& child : table.children) {
    // A key that the override of another document added does not count here.
    const bool put_here = child.bridge || child.origin != table.origin;
    if (!child.known) {
      if (!put_here &&
          (first.node == nullptr || comes_before(child, *first.node)))
        first = {&child, path};
    } else if (child.kind == ConfigNode::Kind::kTable) {
      find_first_unknown(child, joined(path, child.key), first);
    } else {
      find_in_tables(child, joined(path, child.key), first);
    }
  }
}

/// Returns a suggestion in place of the unknown `key` of the table `path`.
std::string advice(const DocumentState& document, const std::string& path,
                   const std::string& key) {
  const std::vector<std::string> here = document.known_keys_in(path);
  const std::string near = suggestion(key, here);
  if (!near.empty()) return fmt::format("did you mean '{}'?", near);
  // An axis, x, has the same name in tables that have nothing in common.
  for (const std::string& other : document.known_keys) {
    if (key.size() > 1 && other.ends_with('.' + key))
      return fmt::format("did you mean '{}'?", other);
  }
  const std::string place = path.empty() ? "this file" : '[' + path + ']';
  if (here.empty()) return fmt::format("{} takes no keys here", place);
  return fmt::format("{} takes {}", place, fmt::join(here, ", "));
}

}  // namespace

std::string joined(const std::string& table, std::string_view key) {
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

void DocumentState::note_known(const std::string& key_path) {
  known_keys.insert(key_path);
  overrides->known_keys.insert(key_path);
}

void DocumentState::note_number(const std::string& key, double value,
                                const Range& range, bool whole) const {
  if (numbers != nullptr) numbers->push_back({key, value, range, whole});
}

void DocumentState::mark_read(const ConfigNode& node) const {
  node.known = true;
  if (node.origin) overrides->overrides[*node.origin].used = true;
}

std::string DocumentState::place(const ConfigNode& node,
                                 FilePosition position) const {
  if (node.origin) {
    const Override& set = overrides->overrides[*node.origin];
    return set.place.empty() ? "set " + printable(set.argument) : set.place;
  }
  return fmt::format("{}:{}:{}", name, position.line, position.column);
}

void DocumentState::fail(const ConfigNode& node, FilePosition position,
                         const std::string& message) const {
  if (node.origin) {
    const Override& set = overrides->overrides[*node.origin];
    if (set.place.empty()) reject_override(set.argument, message);
  }
  throw std::invalid_argument(
      fmt::format("{}: {}", place(node, position), message));
}

std::vector<std::string> DocumentState::known_keys_in(
    const std::string& table) const {
  const std::string start = table.empty() ? "" : table + '.';
  std::vector<std::string> keys;
  for (const std::string& key_path : known_keys) {
    if (!key_path.starts_with(start)) continue;
    std::string key = key_path.substr(start.size());
    if (key.find('.') == std::string::npos) keys.push_back(std::move(key));
  }
  return keys;
}

void DocumentState::reject_unknown_keys() const {
  UnknownKey first;
  find_first_unknown(root, "", first);
  if (first.node == nullptr) return;
  const ConfigNode& node = *first.node;
  const std::string key_path = joined(first.table, node.key);
  fail(node, node.key_position,
       known_keys.contains(key_path)
           ? key_path +
                 ": not used together with the other keys given here; remove it"
           : fmt::format("{}: unknown key; {}", printable(key_path),
                         advice(*this, first.table, node.key)));
}

}  // namespace beamgyro::internal
