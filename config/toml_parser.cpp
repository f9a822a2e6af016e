// SPDX-License-Identifier: MIT
#include "config/toml_parser.h"

#include <algorithm>
#include <utility>

#include "config/toml_library.h"

namespace beamgyro::internal {
namespace {

FilePosition position_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

ConfigNode node_of(const toml::node& parsed);

std::vector<ConfigNode> entries_of(const toml::table& table) {
  std::vector<ConfigNode> entries;
  entries.reserve(table.size());
  for (const auto& [key, value] : table) {
    ConfigNode entry = node_of(value);
    entry.key = std::string(key.str());
    entry.key_position = position_of(key.source());
    entries.push_back(std::move(entry));
  }
  // The library keeps a table sorted by key.
  std::stable_sort(entries.begin(), entries.end(),
                   [](const ConfigNode& a, const ConfigNode& b) {
                     return a.key_position < b.key_position;
                   });
  return entries;
}

ConfigNode node_of(const toml::node& parsed) {
  ConfigNode node;
  node.position = position_of(parsed.source());
  if (const auto* table = parsed.as_table()) {
    node.children = entries_of(*table);
  } else if (const auto* array = parsed.as_array()) {
    node.kind = ConfigNode::Kind::kArray;
    node.children.reserve(array->size());
    for (const toml::node& element : *array)
      node.children.push_back(node_of(element));
  } else if (const auto* text = parsed.as_string()) {
    node.kind = ConfigNode::Kind::kText;
    node.text = text->get();
  } else if (const auto* integer = parsed.as_integer()) {
    node.kind = ConfigNode::Kind::kInteger;
    node.integer = integer->get();
  } else if (const auto* number = parsed.as_floating_point()) {
    node.kind = ConfigNode::Kind::kFloat;
    node.number = number->get();
  } else if (const auto* flag = parsed.as_boolean()) {
    node.kind = ConfigNode::Kind::kFlag;
    node.flag = flag->get();
  } else {
    node.kind = ConfigNode::Kind::kDate;
  }
  return node;
}

}  // namespace

ConfigNode parse_toml(std::string_view text) {
  check_toml_extent(text);
  try {
    return node_of(toml::parse(text));
  } catch (const toml::parse_error& error) {
    throw TomlError(printable(error.description()),
                    position_of(error.source()));
  }
}

}  // namespace beamgyro::internal
